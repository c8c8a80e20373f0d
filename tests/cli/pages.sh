#!/bin/bash
# Manual pages say what the programs do.
. tests/lib.sh

for tool in "${tools[@]}"; do
    "$BIN/$tool" --help | sed -n 's/^  \(-.,\|   \) --\([a-z-]*\).*/\2/p' | sort >"$work/help"
    sed -n 's/^\.It.* Fl -\([a-z-]*\).*/\1/p' "man/$tool.1" | sort >"$work/page"
    check "$tool: has options" test -s "$work/help"
    check "$tool: page and --help list the same options" diff "$work/help" "$work/page"
    "$BIN/$tool" --help | sed -n 's/^  -\(.\), --\([a-z-]*\).*/\1 \2/p' | sort >"$work/help"
    sed -n 's/^\.It Fl \([a-zA-Z]\) .*Fl -\([a-z-]*\).*/\1 \2/p' "man/$tool.1" | sort >"$work/page"
    check "$tool: and the same letters" diff "$work/help" "$work/page"
done

"$LIB/schema_page" >"$work/items"
sed '1,/^\.\\" schema begin/d; /^\.\\" schema end/,$d' man/pneumorph-format.5 >"$work/page"
check "schema has items" test -s "$work/items"
check "pneumorph-format(5) lists the schema (make format-page)" diff "$work/items" "$work/page"

# The example and the reference case of pneumorph-case(5) are cases.
sed -n '/^\[case\]/,/^\.Ed/p' man/pneumorph-case.5 | sed '/^\./d' >"$work/pair.ini"
check "the example of pneumorph-case(5) works" "$BIN/surfgen" "$work/pair.ini" -o "$work/pair.h5"

# Every key the parser knows has its entry.
sed -n 's/^ *{"\([a-z]*\)", "\([a-z0-9_]*\)",.*/\2/p' common/files/case.c >"$work/some"
sed -n '/pm_material_law laws/,/^};/p' common/files/material.c | grep -o '"[a-z0-9]*"' | tr -d '"' | grep -vx 'yeoh\|ogden' >>"$work/some"
sort -u "$work/some" >"$work/keys"
sed -n 's/^\.It Ic //p' man/pneumorph-case.5 | tr -d ',' | tr -s ' ' '\n' | sort -u >"$work/page"
check "the parser has keys" test -s "$work/keys"
check "pneumorph-case(5) lists the keys" diff "$work/keys" "$work/page"
finish
