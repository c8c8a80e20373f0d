# How far the elements are off, by mesh size and by CPU time: sphere and tube against closed forms, Cook's membrane, two
# bellows bodies (data/bodies/bellows.geo) against tet15 on a fine mesh. Tables and a chart in ACCURACY_RUN. One file per
# result; what is there is not made again. About twenty minutes on two cores.
#
#   make accuracy [ACCURACY_RUN=run/NAME] [ACCURACY_ELEMENTS='tet10-blend ..'] [ACCURACY_SIZES='MM ..']

ACCURACY_RUN ?= run/accuracy
ACCURACY_ELEMENTS ?= tet10-blend tet10 tet10-mean tet15 tet4
# The wall of the bellows is 2.5 mm.
ACCURACY_SIZES ?= 2.5 1.75 1.25
ACCURACY_FINE_q ?= 0.83
ACCURACY_FINE_h ?= 1
A := $(ACCURACY_RUN)
ACCURACY = BIN='$B/bin' LIB='$B/tests/lib' PRESSURE=0.12 ELEMENTS='$(ACCURACY_ELEMENTS)' pipelines/accuracy.sh
ACCURACY_TOOLS := $(addprefix $B/bin/,tetmesh fesolve) $(addprefix $B/tests/lib/,thick_sphere slice pressure_noise)
ACCURACY_CURVED := $(filter-out tet4,$(ACCURACY_ELEMENTS))

# Rows MESH+ELEMENT+KAPPA+LAW: both bodies with all elements; other bulk moduli and laws on the symmetric one.
on = $(foreach s,$(2),$(foreach e,$(4),$(1)-$(s)-$(3)+$(e)+$(5)+$(6)))
ACCURACY_ROWS := \
	$(foreach b,q h,$(call on,$b,$(ACCURACY_SIZES),curved,$(ACCURACY_CURVED),100,neo-hookean) \
	$(call on,$b,$(ACCURACY_SIZES),straight,tet10 tet10-blend,100,neo-hookean) \
	$(call on,$b,$(ACCURACY_SIZES),linear,tet4,100,neo-hookean) \
	$(call on,$b,$(ACCURACY_FINE_$b),fine,tet15 tet10-blend,100,neo-hookean)) \
	$(foreach k,10 1000,$(call on,q,$(ACCURACY_SIZES),curved,$(ACCURACY_CURVED),$k,neo-hookean) \
	$(call on,q,$(ACCURACY_FINE_q),fine,tet15,$k,neo-hookean)) \
	$(foreach l,mooney-rivlin yeoh ogden,$(call on,q,2.5 1.25,curved,tet10-blend tet10,100,$l) \
	$(call on,q,$(ACCURACY_FINE_q),fine,tet15,100,$l))
ACCURACY_ROWS := $(ACCURACY_ROWS:%=$A/%.row)
ACCURACY_ROUNDS := $(patsubst %,$A/round-%.tsv,10 100 1000)

.PHONY: accuracy accuracy-results
.PRECIOUS: $A/%.msh $A/%.h5
accuracy: all ## errors of all elements by mesh size and CPU time: tables and a chart in run/accuracy/
	+@$(MAKE) --no-print-directory $(JOBS) accuracy-results
accuracy-results: $A/bellows.tsv $(ACCURACY_ROUNDS) $A/cook.tsv $A/noise.tsv $A/bellows.png
	@for table in $(filter %.tsv,$^); do $(ACCURACY) report $$table; echo; done

$A/%.msh: data/bodies/bellows.geo
	@mkdir -p $A
	$(ACCURACY) mesh $< $@
$A/%.h5: $A/%.msh | $B/bin/tetmesh
	$B/bin/tetmesh -v --import $< --mu 1 --kappa 100 -o $@
# A row needs the mesh that its name begins with.
$(foreach row,$(ACCURACY_ROWS),$(eval $(row): $(firstword $(subst +, ,$(row))).h5))
$(ACCURACY_ROWS): | $(ACCURACY_TOOLS)
	$(ACCURACY) row $< $@
$A/round-%.tsv: | $(ACCURACY_TOOLS)
	@mkdir -p $A
	$(ACCURACY) round $* >$@
$A/cook.tsv: | $(ACCURACY_TOOLS)
	@mkdir -p $A
	$(ACCURACY) cook >$@
$A/bellows.tsv: $(ACCURACY_ROWS)
	$(ACCURACY) table $^ >$@
$A/noise.tsv: $(ACCURACY_ROWS)
	$(ACCURACY) noise $^ >$@
$A/bellows.png: $A/bellows.tsv pipelines/pictures/accuracy.gp
	gnuplot -c pipelines/pictures/accuracy.gp $< $@
