# Gauss sets against each other: full and reduced by symmetry, boundary and volume form, by points per axis, on small
# bodies with exactly the symmetry of the design cases. A table in SETS_RUN; about ten minutes.
#
#   make sets [SETS_RUN=run/NAME] [SETS_SIZE=MM]

SETS_RUN ?= run/sets
SETS_SIZE ?=
SETS_BODIES := tiny-2T tripod-3T tripod-2R twisted-3R opposed-1R2T six-3R3T
# 2R has no volume form; six chambers have 12 faces and no more than two points per axis in minutes.
SETS_ROWS := $(filter-out tripod-2R-volume-% $(foreach m,3 4,six-3R3T-boundary-$m six-3R3T-volume-$m), \
	$(foreach b,$(SETS_BODIES),$(foreach f,boundary volume,$(foreach m,2 3 4,$b-$f-$m))))
SETS_ROWS := $(SETS_ROWS:%=$(SETS_RUN)/%.row)
SETS_MESHES := $(foreach b,tiny tripod twisted opposed six,$(SETS_RUN)/$b.h5)
SETS = BIN='$B/bin' pipelines/sets.sh

.PHONY: sets sets-results
sets: all ## full against reduced Gauss sets, boundary against volume form: a table in run/sets/
	+@$(MAKE) --no-print-directory $(JOBS) sets-results
sets-results: $(SETS_RUN)/sets.md
	@cat $<
$(SETS_MESHES): $(SETS_RUN)/%.h5: tests/data/%.ini | $(addprefix $B/bin/,surfgen tetmesh fesolve wsint)
	@mkdir -p $(@D)
	$(SETS) mesh $< '$(SETS_SIZE)' $@
$(SETS_ROWS):
	$(SETS) row $@
$(foreach mesh,$(SETS_MESHES),$(eval $(filter $(mesh:.h5=)-%,$(SETS_ROWS)): $(mesh)))
$(SETS_RUN)/sets.md: $(SETS_ROWS)
	$(SETS) table $^ >$@
