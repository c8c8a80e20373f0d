#!/bin/bash
# What every tool does alike: help, version, usage errors.
. tests/lib.sh

for tool in "${tools[@]}"; do
    expect 0 "$tool --help" "$BIN/$tool" --help
    check "$tool: help on standard output" grep -q "^usage: $tool " "$work/out"
    expect 0 "$tool -h" "$BIN/$tool" -h
    for option in output verbose quiet help version; do
        check "$tool: help lists --$option" grep -q -- "--$option" "$work/out"
    done
    expect 0 "$tool --version" "$BIN/$tool" --version
    check "$tool: version" grep -qF "$tool (pneumorph) $(cat VERSION)" "$work/out"
    expect 0 "$tool -V" "$BIN/$tool" -V
    check "$tool: HDF5 version" grep -q "HDF5 1\." "$work/out"
    refused 2 "$tool: unknown long option" "^$tool: .*'--no-such-option'" "$BIN/$tool" --no-such-option
    refused 2 "$tool: unknown letter" "^$tool: .*'-Y'" "$BIN/$tool" -Y
    refused 2 "$tool: -o without a value" "^$tool: option '-o' needs a value" "$BIN/$tool" -o
    refused 2 "$tool: no operands" "^$tool: " "$BIN/$tool" -o "$work/output/x.h5"
done
finish
