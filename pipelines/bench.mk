# fesolve against CalculiX on the same meshes to the same result, and its own growth with the size of the problem, one
# thread each: table and chart in BENCH_RUN. One file per result; what is there is not made again.
#
#   make bench [BENCH_RUN=run/NAME] [BENCH_CASE=CASE.ini] [BENCH_COMPARE='MM ..'] [BENCH_SIZES='MM ..']
#
# CalculiX takes minutes at 100 000 unknowns; BENCH_COMPARE= leaves it out.

BENCH_RUN ?= run/bench
BENCH_CASE ?= data/cases/three-capsules.ini
BENCH_PRESSURE ?= 0.12,0,0
# Mesh sizes [mm]: about 24 and 100 thousand unknowns; 17 to 380 thousand.
BENCH_COMPARE ?= 4 2.6
BENCH_SIZES ?= 5.5 4 3.2 2.6 1.7 1.6
# Runs of which the median counts, where one takes less than 20 s.
BENCH_REPEATS ?= 3
R := $(BENCH_RUN)
BENCH = BIN='$B/bin' LIB='$B/tests/lib' PRESSURE='$(BENCH_PRESSURE)' REPEATS='$(BENCH_REPEATS)' pipelines/bench.sh
BENCH_TOOLS := $(addprefix $B/bin/,surfgen tetmesh fesolve meshexport)
BENCH_ROWS := $(BENCH_SIZES:%=$R/tet10-blend-%.row) $(BENCH_COMPARE:%=$R/tet10-%.row) $(BENCH_COMPARE:%=$R/calculix-%.row) $R/dgemm.row

.PHONY: bench bench-results
.PRECIOUS: $R/surf.h5 $R/mesh-%.h5 $R/calculix-%/job.dat
bench: all ## fesolve against CalculiX and against its own size: a table and a chart in run/bench/
	+@$(MAKE) --no-print-directory -j1 bench-results
bench-results: $R/bench.tsv $R/bench.png
	@$(BENCH) report $<

$R/surf.h5: $(BENCH_CASE) | $B/bin/surfgen
	@mkdir -p $R
	$B/bin/surfgen $< -o $@
$R/mesh-%.h5: $R/surf.h5 | $B/bin/tetmesh
	$B/bin/tetmesh -v --size $* $< -o $@
$R/tet10-blend-%.row: $R/mesh-%.h5 $B/bin/fesolve
	$(BENCH) fesolve $< tet10-blend $@
$R/tet10-%.row: $R/mesh-%.h5 $B/bin/fesolve
	$(BENCH) fesolve $< tet10 $@
$R/calculix-%/job.dat: $R/mesh-%.h5 | $B/bin/meshexport
	$(BENCH) calculix $< $@
$R/calculix-%.row: $R/calculix-%/job.dat $R/tet10-%.row $B/bin/meshexport
	$(BENCH) compare $R/tet10-$*.h5 $< $@
$R/dgemm.row: $B/tests/lib/dgemm
	$(BENCH) dgemm $@
$R/bench.tsv: $(BENCH_ROWS)
	$(BENCH) table $^ >$@
$R/bench.png: $R/bench.tsv pipelines/pictures/bench.gp
	gnuplot -c pipelines/pictures/bench.gp $< $@
