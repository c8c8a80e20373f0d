# Inverse kinematics of a planar robot in its components 1, 3, 5: random poses that it can take; a fixed position with a
# changing angle (turn); a fixed angle with a changing position (shift). Tables in INVKIN_RUN, a summary on stdout.
#
#   make invkin [INVKIN_RUN=run/NAME] [INVKIN_CASE=data/cases/NAME.ini INVKIN_SIZE=MM | INVKIN_MESH=run/NAME/it010/mesh.h5]

INVKIN_RUN ?= run/invkin
INVKIN_CASE ?= data/cases/3A1R2T.ini
INVKIN_SIZE ?= 8
INVKIN_MAX ?= 0.12
INVKIN_COUNT ?= 50
I := $(INVKIN_RUN)
INVKIN_MESH ?= $I/mesh.h5
INVKIN_TABLES := $(patsubst %,$I/%.tsv,random turn shift)
INVKIN = BIN='$B/bin' pipelines/invkin.sh

.PHONY: invkin invkin-results
.SECONDARY: $(INVKIN_TABLES:.tsv=.txt)
invkin: all ## pressures for 50 random poses, for a fixed position and for a fixed angle: tables in run/invkin/
	+@$(MAKE) --no-print-directory $(JOBS) invkin-results
invkin-results: $(INVKIN_TABLES)
	@$(INVKIN) report $^

$I/mesh.h5: $(INVKIN_CASE) | $B/bin/surfgen $B/bin/tetmesh
	@mkdir -p $I
	$B/bin/surfgen $< -o $I/surf.h5
	$B/bin/tetmesh --size $(INVKIN_SIZE) $I/surf.h5 -o $@
$I/%.txt: $(INVKIN_MESH) | $B/bin/fesolve $B/bin/pmplot
	@mkdir -p $I
	$(INVKIN) targets $* $< $(INVKIN_MAX) $(if $(filter random,$*),$(INVKIN_COUNT),9) >$@
$(INVKIN_TABLES): $I/%.tsv: $I/%.txt $(INVKIN_MESH) | $B/bin/invkin
	$B/bin/invkin -q --table --dofs 1,3,5 --bounds 0,$(INVKIN_MAX) --targets $< $(INVKIN_MESH) -o $I/$*.h5 >$@
