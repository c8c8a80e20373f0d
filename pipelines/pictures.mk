# Pictures and the report of a run, from its files: make pictures RUN=run/NAME, make report RUN=run/NAME.
.PHONY: pictures report
PLOTTERS := $(addprefix $B/bin/,pmplot trstep wsint fesolve)
pictures: $(PLOTTERS) ## draw RUN/pictures/*.png of a run: RUN=run/NAME
	+@BIN='$(BIN)' MAKE='$(MAKE)' pipelines/pictures.sh '$(RUN)'
report: $(PLOTTERS) ## print the history and the first and best measure by both forms: RUN=run/NAME
	+@BIN='$(BIN)' MAKE='$(MAKE)' pipelines/report.sh '$(RUN)'
.PHONY: jumps
jumps: $(OPTIMISERS) ## print what new meshes and new control points did to the measure of a run, renewal by renewal: RUN=run/NAME
	+@BIN='$(BIN)' MAKE='$(MAKE)' pipelines/jumps.sh '$(RUN)'
.PHONY: progress
progress: ## measures of runs against iterations and time: RUNS='run/A run/B' [OUT=run/progress]
	@pipelines/progress.sh '$(or $(OUT),run/progress)' $(RUNS)
