#!/bin/bash
# The work of shapes.mk:
#   shapes.sh row NUMBER FILE      one shape
#   shapes.sh table ROW..          all rows with a header
#   shapes.sh report TABLE         counts; status 1 where a shape has no sound end
# BIN, LIB: programs of the build.
set -u
export LC_ALL=C

case_text() {
    awk -v seed="$1" 'function u(lo, hi) { return lo + (hi - lo) * rand() }
    BEGIN {
        srand(7919 * seed); rand()
        three = rand() < 0.5; amplitude = u(0, 3.5); pitch = u(10, 16); wall = u(1.2, 3); noise = u(0, 1.5); size = u(3, 4.5)
        split(three ? "c3|c3 mirror-y|none" : "mirror-x mirror-y|mirror-y|none", group, "|")
        g = group[1 + int(3 * rand())]
        radius = 7; offset = (radius + amplitude + wall / 2 + 0.5) * (three ? 1.16 : 1)
        printf "# %s %d %.2f %.2f %.2f %.2f %.2f\n", g, 2 + three, amplitude, pitch, wall, noise, size
        printf "[case]\nname = shape\n[material]\nlaw = neo-hookean\nmu = 0.5\nkappa = 25\n"
        printf "[body]\nshape = envelope\nheight = 70\nwall = %.3f\nweb = 6\naround = 36\nrows = 40\n", wall
        n = g == "none" || g == "mirror-y" ? 2 + three : 1
        for (k = 0; k < n; k++) {
            t = 2 * 3.14159265358979 * k / (2 + three)
            printf "[chamber%d]\nshape = bellows\ncenter = %.9f, %.9f, 35\nradius = 7\nlength = 58\n", k + 1, offset * cos(t), offset * sin(t) * three
            printf "amplitude = %.3f\npitch = %.3f\nspacing = 2.4\n", amplitude, pitch
        }
        if (g != "none") printf "[symmetry]\ngroup = %s\n", g
        printf "[mesh]\nsize = %.2f\n[constraints]\nwall_min = 0.9\ncap_min = 1\n", size
    }'
}

# Only what was found, without numbers.
reason() {
    tail -n 1 | sed 's/^[a-z]*: //; s/ at (.*//; s/chamber [0-9]*/chamber/g; s/[0-9.e+-]* mm/N mm/g; s/surface [0-9]*/surface/g; s/[0-9][0-9.e-]*/N/g'
}

row() {
    local status=0 seen mesh=- quality=- damping=- found
    work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
    case_text "$1" >"$work/case.ini"
    read -r -a drawn < <(sed -n '1s/^# //; 1s/mirror-x mirror-y/mirrors/; 1s/c3 mirror-y/c3v/; 1p' "$work/case.ini")
    if ! "$BIN/surfgen" -q "$work/case.ini" -o "$work/plain.h5" 2>"$work/err" ||
        ! seen=$("$LIB/random_shape" "$1" "${drawn[5]}" "$work/plain.h5" "$work/s.h5" 2>"$work/err"); then
        found="no surfaces: $(reason <"$work/err")"
        seen=$'-\t-\t-'
    else
        "$BIN/tetmesh" -v --timeout 60 "$work/s.h5" -o "$work/m.h5" 2>"$work/err" || status=$?
        case $status in
        0)
            found=meshed
            mesh=$(sed -n 's/.* nodes, \([0-9]*\) tetrahedra.*/\1/p' "$work/err")
            quality=$(sed -n 's/.*smallest scaled Jacobian \([0-9.]*\).*/\1/p' "$work/err")
            damping=$(sed -n 's/.*damped by up to .*, \([0-9.e-]*\) mm off.*/\1/p' "$work/err")
            grep -q 'meshed by Delaunay' "$work/err" && found="meshed by Delaunay"
            "$LIB/check_mesh" "$work/m.h5" "$work/s.h5" 0.1 >"$work/out" || found="INVALID: $(grep -v 'mm3' "$work/out" | head -n 1)"
            ;;
        3) found="refused: $(reason <"$work/err")" ;;
        *) found="FAILED: $(reason <"$work/err")" ;;
        esac
    fi
    (IFS=$'\t' && printf '%s\t%s\t%s\t%s\t%s\t%s\t%s\n' "$1" "${drawn[*]}" "$seen" "$mesh" "$quality" "$damping" "$found") >"$2.part" &&
        mv "$2.part" "$2"
}

table() {
    printf 'shape\tgroup\tchambers\tamplitude\tpitch\twall\tnoise\tsize\tcloses\tcurvature\tfault\ttetrahedra\tquality\tdamping\tfound\n'
    cat "$@"
}

# A refusal is true where the samples see a fault, or walls below the half of a millimetre; shapes with a fault are refused.
report() {
    awk -F '\t' 'NR > 1 {
        n++; count[$15]++
        if ($15 ~ /^meshed/) {
            meshed++
            if (worst == "" || $13 < worst) { worst = $13; at = $1 }
            if ($14 > most) { most = $14; most_at = $1 }
            if ($11 != "-") { faulty++; list = list " " $1 }
        } else if ($15 ~ /^refused/) {
            if ($11 == "-" && $9 > 0.5) { unseen++; unlist = unlist " " $1 }
        } else if ($15 !~ /^no surfaces/) bad++
    }
    END {
        for (c in count) printf "%4d  %s\n", count[c], c | "sort -k1,1nr -k2"
        close("sort -k1,1nr -k2")
        printf "%d of %d shapes meshed, worst scaled Jacobian %s (shape %s), largest damping %s mm (shape %s)\n", meshed, n, worst, at, most, most_at
        printf "%d refused where samples see no fault:%s\n%d meshed where they see one:%s\n", unseen, unlist, faulty, list
        exit bad + unseen + faulty > 0
    }' "$1"
}

"$@"
