# One design, several meshes: what a mesh is worth.
SIZES ?= 6 5 4 3 2.5
.PHONY: meshes
meshes: $(addprefix $B/bin/,surfgen tetmesh fesolve wsint) ## the measure of one design on several meshes: RUN=.. or CASE=.. [SIZES='6 5 4 3 2.5']
	@BIN='$(BIN)' pipelines/meshes.sh '$(RUN)' '$(CASE)' '$(SIZES)'
