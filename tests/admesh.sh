# ADMesh, an independent judge of STL files: source it after tests/lib.sh.
# shellcheck shell=bash disable=SC2154

# sound FILE PARTS: ADMesh finds that many closed parts and nothing to repair.
sound() {
    admesh "$1" >"$work/admesh" 2>&1
    cat "$work/admesh"
    awk -v parts="$2" '
        /disconnected/ { open += $NF + $(NF - 1) }
        /^Number of parts/ { n = $5 }
        /^(Degenerate facets|Edges fixed|Facets removed|Facets added|Facets reversed|Backwards edges|Normals fixed)/ {
            seen++
            split($0, p, ":"); repaired += p[2] }
        END { exit !(seen == 7 && repaired == 0 && open == 0 && n == parts) }' "$work/admesh"
}
