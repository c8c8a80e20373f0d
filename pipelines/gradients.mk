# How accurate the shape derivatives are, by mesh size, bulk modulus and form: the thick sphere against its radial
# equation (error of dub/dA, dub/dB, d2ub/dpdA, d2ub/dpdB), the two forms on the chambers and the exterior of a robot, and
# the gradient of every measure against differences of the whole computation. Tables and a chart in GRADIENTS_RUN; about
# five minutes.
#
#   make gradients [GRADIENTS_RUN=run/NAME] [GRADIENTS_CASE=data/cases/NAME.ini]

GRADIENTS_RUN ?= run/gradients
GRADIENTS_CASE ?= data/cases/2A0R2T.ini
# Parts a side x layers of the octant; sizes of the robot's mesh [mm].
GRADIENTS_PARTS ?= 3x2 4x3 6x4 8x6 12x8
GRADIENTS_SIZES ?= 6 5 4
# One case for each measure.
GRADIENTS_CASES ?= 2A0R2T 3A0R3T 3A2R0T 3A3R0T 3A1R2T
G := $(GRADIENTS_RUN)
GRADIENTS = BIN='$B/bin' LIB='$B/tests/lib' pipelines/gradients.sh
GRADIENTS_ROWS := $(foreach k,10 100 1000,$(foreach n,$(GRADIENTS_PARTS),$G/sphere-$k-$n.row)) $(GRADIENTS_SIZES:%=$G/robot-%.row) \
	$(GRADIENTS_CASES:%=$G/measure-%.row)

.PHONY: gradients gradients-results
gradients: all ## errors of both forms of the shape derivative by mesh size: tables and a chart in run/gradients/
	+@$(MAKE) --no-print-directory $(JOBS) gradients-results
gradients-results: $G/sphere.tsv $G/robot.tsv $G/measure.tsv $G/gradients.png
	@for table in $(filter %.tsv,$^); do $(GRADIENTS) report $$table; echo; done
$(GRADIENTS_ROWS): | $(addprefix $B/bin/,surfgen tetmesh fesolve wsint adjsens) $(addprefix $B/tests/lib/,thick_sphere sphere_shape growth)
	@mkdir -p $G
	$(GRADIENTS) row '$(GRADIENTS_CASE)' $@
$G/sphere.tsv $G/robot.tsv $G/measure.tsv: $G/%.tsv: $(GRADIENTS_ROWS)
	$(GRADIENTS) table $* $(filter $G/$*-%,$^) >$@
$G/gradients.png: $G/sphere.tsv pipelines/pictures/gradients.gp
	gnuplot -c pipelines/pictures/gradients.gp $< $@
