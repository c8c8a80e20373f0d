#!/bin/bash
# make install and uninstall under DESTDIR; what is installed runs.
. tests/lib.sh

root=$work/root
check "install" make -s B="$BUILD" install DESTDIR="$root" PREFIX=/usr
for tool in "${tools[@]}"; do
    check "$tool runs" "$root/usr/bin/$tool" --version
    check "$tool has a page" test -s "$root/usr/share/man/man1/$tool.1"
done
for page in man5/pneumorph-case.5 man5/pneumorph-format.5 man7/pneumorph.7 man7/pneumorph-model.7; do
    check "$page" test -s "$root/usr/share/man/$page"
done
check "the case is there" cmp data/cases/2A0R2T.ini "$root/usr/share/pneumorph/cases/2A0R2T.ini"
check "the body is there" cmp data/bodies/bellows.geo "$root/usr/share/pneumorph/bodies/bellows.geo"
check "uninstall" make -s B="$BUILD" uninstall DESTDIR="$root" PREFIX=/usr
check "uninstall leaves no file" test -z "$(find "$root" -type f)"
expect 0 "make help" make -s help
for target in all accuracy check demo deps invkin lint install uninstall clean; do
    check "make help lists $target" grep -q "^$target  *[a-zA-Z]" "$work/out"
done
finish
