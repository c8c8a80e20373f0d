# Random smooth shapes: each one is meshed with valid elements or refused with the true reason. Two and three chambers,
# with and without symmetry, bellows up to 3.5 mm deep, walls from 1 mm, noise up to 1.5 mm; drawn by their number.
# Rows in SHAPES_RUN, one file each; what is there is not made again.
#
#   make shapes [SHAPES=N] [SHAPES_RUN=run/NAME]

SHAPES ?= 200
SHAPES_RUN ?= run/shapes
SHAPES_ROWS := $(shell seq -f '$(SHAPES_RUN)/%03g.row' $(SHAPES))
SHAPE = BIN='$B/bin' LIB='$B/tests/lib' pipelines/shapes.sh

.PHONY: shapes shapes-results
shapes: all ## random shapes, meshed or refused for the true reason: a table (SHAPES=N)
	+@$(MAKE) --no-print-directory $(JOBS) shapes-results
shapes-results: $(SHAPES_RUN)/shapes.tsv
	@$(SHAPE) report $<
$(SHAPES_RUN)/shapes.tsv: $(SHAPES_ROWS)
	@$(SHAPE) table $^ >$@
$(SHAPES_ROWS): | $(B)/bin/surfgen $(B)/bin/tetmesh $(B)/tests/lib/random_shape $(B)/tests/lib/check_mesh
	@mkdir -p $(@D)
	@$(SHAPE) row $(basename $(notdir $@)) $@
