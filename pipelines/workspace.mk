# The dense workspace of a design: equilibria all over the boundary of the actuation box, the measure by quadrature on
# them beside the Gauss values, the surface of the workspace as VTKHDF and as a picture.
#
#   make -j2 workspace CASE=data/cases/NAME.ini [RUN=run/NAME] [SIZE=MM] [STEP=0.006] [MEASURE=2R]    of the first design of a case
#   make -j2 workspace RUN=run/NAME [STEP=0.006]                        of the last accepted design of an optimisation
#
# Everything goes to RUN/workspace/; table.md holds the values, also by every other sample. Symmetry leaves few of the points; they are solved in
# parts of at most 64 by continuation, beside each other under make -j. RULES are the Gauss sets to compare with, by form and
# points per axis: RULES= for none, where states are dear. A stopped target goes on where it was.

STEP ?= 0.006
MEASURE ?=
RULES ?= boundary-2 boundary-3 volume-2 volume-3
.PHONY: workspace
workspace: $(addprefix $B/bin/,surfgen tetmesh fesolve wsint pmplot trstep) ## dense workspace of a design: CASE=.. or RUN=.. [STEP=0.006] [SIZE=MM]
	+@BIN='$(BIN)' MAKE='$(MAKE)' JOBS='$(JOBS)' pipelines/workspace.sh '$(RUN)' '$(CASE)' '$(STEP)' '$(SIZE)' '$(MEASURE)' '$(RULES)'

# One list of pressures, one path.
ifneq ($(WORKSPACE),)
$(WORKSPACE)/%.h5: $(WORKSPACE)/%.txt $(WORKSPACE)/mesh.h5
	@$(LAUNCH) $(BIN)/fesolve --path $< $(WORKSPACE)/mesh.h5 -o $@
endif

# Results side by side.
RUNS ?= $(sort $(patsubst %/history.tsv,%,$(wildcard run/*/history.tsv)) $(patsubst %/workspace/workspace.h5,%,$(wildcard run/*/workspace/workspace.h5)))
BASELINE ?=
.PHONY: table compare
table: $B/bin/wsint ## all cases beside the paper's numbers, in Markdown: [RUNS='run/NAME ..']
	@BIN='$(BIN)' pipelines/table.sh table $(RUNS)
compare: $B/bin/wsint ## gain of a dense workspace over a baseline: RUN=run/NAME BASELINE=run/OTHER
	@BIN='$(BIN)' pipelines/table.sh compare '$(RUN)' '$(BASELINE)'
