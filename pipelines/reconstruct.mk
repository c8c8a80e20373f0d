# What repeated reconstructions do to a bellows of 477 control points: the methods of surfremesh side by side, forced
# RECONSTRUCT_CALLS times each. A table for each method (call, CPU seconds, control points, volume over that of the first
# form, mean and largest distance from it [mm], variation of the edges and of the distances to the nearest neighbour), a
# summary, and a chart in RECONSTRUCT_RUN. About four CPU minutes.
#
#   make reconstruct [RECONSTRUCT_RUN=run/NAME] [RECONSTRUCT_CALLS=N]

RECONSTRUCT_RUN ?= run/reconstruct
RECONSTRUCT_CALLS ?= 40
S := $(RECONSTRUCT_RUN)
RECONSTRUCT_TABLES := $(patsubst %,$S/%.tsv,remesh conformal paper)

.PHONY: reconstruct reconstruct-results
reconstruct: all ## what 40 reconstructions do to a bellows, by method: tables and a chart in run/reconstruct/
	+@$(MAKE) --no-print-directory $(JOBS) reconstruct-results
reconstruct-results: $(RECONSTRUCT_TABLES) $S/drift.png
	@pipelines/reconstruct.sh report $(RECONSTRUCT_TABLES)

$S/first.h5: data/bodies/bellows-477.ini | $B/bin/surfgen
	@mkdir -p $S
	$B/bin/surfgen $< -o $@
$(RECONSTRUCT_TABLES): $S/%.tsv: $S/first.h5 | $B/bin/surfremesh $B/tests/lib/surface_drift
	BIN='$B/bin' LIB='$B/tests/lib' pipelines/reconstruct.sh calls $* $(RECONSTRUCT_CALLS) $< $@
$S/drift.png: $(RECONSTRUCT_TABLES) pipelines/pictures/reconstruct.gp
	gnuplot -c pipelines/pictures/reconstruct.gp $S $@
