# One design, several meshes: what a mesh is worth. SIZES are wanted edges [mm], or SIZE/CREST where crests are resolved
# otherwise than the case says.
SIZES ?= 6 5 4 3 2.5
.PHONY: meshes
meshes: $(addprefix $B/bin/,surfgen tetmesh fesolve wsint) ## the measure of one design on several meshes: RUN=.. or CASE=.. [SIZES='6 5 4 3 2.5 4/1']
	@BIN='$(BIN)' pipelines/meshes.sh '$(RUN)' '$(CASE)' '$(SIZES)'
