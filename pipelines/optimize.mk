# The optimisation loop. One folder per iteration, one file per stage, one target per file:
#
#   make -j2 optimize CASE=data/cases/2A0R2T.ini RUN=run/NAME [SIZE=MM] [SET='section.key=value ..'] [ITERATIONS=N]
#        [DESIGN=data/designs/NAME.h5]
#   make -j2 it007 RUN=run/NAME            up to one iteration
#   make -j2 RUN=run/NAME ITER=it007 run/NAME/it007/work.h5    one file of one iteration
#
# RUN/case.ini is the case of the run (CASE with the lines of SET replaced; SIZE is short for mesh.size). DESIGN
# is a surface or step file to start from instead of the shapes of the case. A stopped run goes on where it was: files appear
# whole or not at all, and nothing is made twice. LAUNCH is put before the heavy stages, for instance
# LAUNCH='srun -n1 -c1'. pipelines/optimize.sh walks through the iterations and ends at the verdict of trstep.

RUN ?=
CASE ?=
SIZE ?=
SET ?=
ITERATIONS ?=
DESIGN ?=
ITER ?=
LAUNCH ?=
BIN := $(abspath $B)/bin
OPTIMISERS := $(addprefix $B/bin/,surfgen surfremesh tetmesh fesolve wsint adjsens trstep)

WALK = BIN='$(BIN)' MAKE='$(MAKE)' pipelines/optimize.sh '$(RUN)' '$(CASE)' '$(if $(SIZE),mesh.size=$(SIZE)) $(SET)' '$(DESIGN)'
.PHONY: optimize
optimize: $(OPTIMISERS) ## optimise a design: CASE=data/cases/NAME.ini RUN=run/NAME [SIZE=MM] [DESIGN=FILE.h5] [SET=..] [ITERATIONS=N] [LAUNCH=..]
	+@$(WALK) '$(ITERATIONS)'

NAME ?=
.PHONY: design
design: $B/bin/surfgen ## keep the last accepted design of a run with its history: RUN=run/NAME NAME=data/designs/NAME
	@[ -e '$(RUN)/history.tsv' ] && [ -n '$(NAME)' ] || { echo 'design: expected RUN=run/NAME of an optimisation and NAME=data/designs/NAME' >&2; exit 2; }
	mkdir -p $(dir $(NAME))
	$(BIN)/surfgen --design $(lastword $(sort $(wildcard $(RUN)/it*/step.h5))) $(RUN)/case.ini -o $(NAME).h5
	cp $(RUN)/history.tsv $(NAME).tsv

RUN_TO := $(filter it0% it1% it2% it3% it4% it5% it6% it7% it8% it9%,$(MAKECMDGOALS))
.PHONY: $(RUN_TO)
$(RUN_TO): it%: $(OPTIMISERS)
	+@$(WALK) '$*'

# The rules of iteration ITER; everything of the earlier ones exists.
ifneq ($(ITER),)
D := $(RUN)/$(ITER)
NUMBER := $(shell printf %d $$((10#$(ITER:it%=%))))
PREV := $(RUN)/it$(shell printf %03d $$((10#$(ITER:it%=%) - 1)))
NG := $(shell $(BIN)/wsint --points $(RUN)/case.ini | awk 'NR > 1' | wc -l)
POINTS := $(shell seq -f %02g 0 $$(($(NG) - 1)))
STATES := $(POINTS:%=$D/state-%.h5)
SENSES := $(POINTS:%=$D/sens-%.h5)
FIRST := $(filter 0,$(NUMBER))
# trstep says when control points and mesh are to be renewed; that is an iteration of its own, of the accepted design.
NEXT := $(if $(FIRST),,$(shell $(BIN)/trstep --next $(PREV)/step.h5))
RENEW := $(filter renew,$(NEXT))

STAGE = pipelines/stage.sh '$(RUN)' '$(ITER)'
# The last accepted iteration, whose mesh and states are the nearest ones.
LAST = $(RUN)/$$($(BIN)/trstep --history $(PREV)/step.h5 | awk -F '\t' '$$2 == 1 { a = $$1 } END { printf "it%03d", a }')

$D:
	@mkdir -p $@
$D/step.h5: | $D

ifneq ($(FIRST),)
SURF := $D/surf.h5
$(SURF): $(RUN)/case.ini | $D
	@$(STAGE) surfgen $(BIN)/surfgen $(addprefix --design ,$(wildcard $(RUN)/start.h5)) $< -o $@
else ifneq ($(RENEW),)
SURF := $D/surf.h5
$(SURF): $(PREV)/step.h5 | $D
	@$(STAGE) surfremesh $(LAUNCH) $(BIN)/surfremesh --or-keep $< -o $@
else
SURF := $(PREV)/step.h5
endif

# Trials are compared on one mesh, morphed; where it does not bear that, the next iteration renews it, or the trial is
# meshed anew if it is a leap.
PREVIOUS_MESH = $(if $(FIRST)$(RENEW),,--previous $(LAST)/mesh.h5 $(if $(filter trial,$(NEXT)),--keep-mesh))
GUESS = $(if $(FIRST),,--guess $(LAST)/$(@F))
PREVIOUS_STEP = $(if $(FIRST),,--previous $(PREV)/step.h5)
SIGN = $(if $(FIRST),,--sign-from $(RUN)/it000/work.h5)

$D/mesh.h5: $(SURF) | $D
	@$(STAGE) tetmesh $(LAUNCH) $(BIN)/tetmesh --record-failure $(PREVIOUS_MESH) $< -o $@
$(STATES): $D/state-%.h5: $D/mesh.h5
	@$(STAGE) 'fesolve $*' $(LAUNCH) $(BIN)/fesolve --record-failure --load $(shell printf %d $$((10#$*))) $(GUESS) $< -o $@
$D/work.h5: $(STATES)
	@$(STAGE) wsint $(BIN)/wsint --record-failure $(SIGN) $^ -o $@
$(SENSES): $D/sens-%.h5: $D/state-%.h5 $D/work.h5
	@$(STAGE) 'adjsens $*' $(LAUNCH) $(BIN)/adjsens $^ -o $@
# No adjoint work on a rejected trial: the judgement decides which files the step needs.
$D/step.h5: $(SURF) $D/work.h5
	+@if [ "$$($(BIN)/trstep --judge $(SURF) $D/work.h5 $(PREVIOUS_STEP))" = accept ]; then sens='$(SENSES)'; else sens=; fi; \
	[ -z "$$sens" ] || $(MAKE) --no-print-directory $$sens && \
	$(STAGE) trstep $(BIN)/trstep $(SURF) $D/work.h5 $$sens $(PREVIOUS_STEP) -o $@

# What only reports and pictures need: the points of the volume form, the measure by both forms, the corners of the
# actuation box.
VOLUMES := $(patsubst %,$D/volume-%.h5,$(shell seq -f %02g 0 $$(($(shell $(BIN)/wsint --points --form volume $(RUN)/case.ini 2>/dev/null | awk 'NR > 1 && $$3 > 0' | wc -l) - 1))))
$(VOLUMES): $D/volume-%.h5: $D/mesh.h5 | $(STATES)
	@$(STAGE) 'volume $*' $(LAUNCH) $(BIN)/fesolve --form volume --load $(shell printf %d $$((10#$*))) $(addprefix --guess ,$(STATES)) $< -o $@
$D/both.h5: $(STATES) $(VOLUMES)
	@$(STAGE) wsint $(BIN)/wsint $(SIGN) $^ -o $@
# A renewed design on the mesh before it: what of the jump comes with the control points, what with the mesh.
KEPT := $(POINTS:%=$D/kept-%.h5)
$D/kept-mesh.h5: $D/surf.h5
	@$(STAGE) 'tetmesh kept' $(LAUNCH) $(BIN)/tetmesh --record-failure --previous $(LAST)/mesh.h5 --keep-mesh $< -o $@
$(KEPT): $D/kept-%.h5: $D/kept-mesh.h5
	@$(STAGE) 'kept $*' $(LAUNCH) $(BIN)/fesolve --record-failure --load $(shell printf %d $$((10#$*))) --guess $(LAST)/state-$*.h5 $< -o $@
$D/kept.h5: $(KEPT)
	@$(STAGE) 'wsint kept' $(BIN)/wsint --record-failure $(SIGN) $^ -o $@
comma := ,
# From the least to the largest pressure of the box, the corners of which every interval has.
PRESSURES = $(shell $(BIN)/wsint --boundary 1 $(RUN)/case.ini | tr ' \t' '\n\n' | sort -gu)
CORNERS := $(patsubst %,$D/corner-%.h5,0-0 1-0 1-1 0-0-0 1-0-0 1-1-1 0-0-0-0-0-0 1-0-0-0-0-0 1-1-1-1-1-1)
$(CORNERS): $D/corner-%.h5: $D/mesh.h5 | $(STATES)
	@$(STAGE) 'corner $*' $(LAUNCH) $(BIN)/fesolve $(addprefix --guess ,$(STATES)) $< -o $@ \
		--pressure $(subst a,$(firstword $(PRESSURES)),$(subst b,$(lastword $(PRESSURES)),$(subst 0,a,$(subst 1,b,$(subst -,$(comma),$*)))))
endif
