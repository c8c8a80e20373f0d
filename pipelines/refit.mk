# A body that comes as a gmsh mesh against the robot whose surfaces are fitted to its boundary, solved alike: what the fit and
# the curved elements change. The mesh has the groups of tetmesh(1), no symmetry planes, its base in z = 0 and its tip at the
# upper end; it may be packed by gzip.
#
#   make refit MSH=FILE.msh MU=MPA PRESSURE=MPA[,MPA..] [KAPPA=MPA] [REFIT_SPACING=MM] [REFIT_SIZE=MM] [REFIT_CREST=N]
#        [REFIT_ELEMENT=NAME] [REFIT_RUN=run/NAME]
#
# PRESSURE: one of each chamber, or one for all. REFIT_SPACING: of the control points, by default the mean edge of the
# tetrahedra given over 1.5. REFIT_SIZE: edges of the new mesh, by default such that its mean edge is the given one's within 3 %.
# REFIT_CREST: see `crest` in pneumorph-case(5); the default hardly refines curved parts, so that meshes are as uniform as
# those of most meshers.
# Edges of chambers should be rounded: the fit nearly folds at sharp ones, and tetmesh refuses that.
# Tetrahedra of 4 nodes get 10 with straight edges, and the new mesh is solved with straight edges, too; the given mesh is solved
# once more with its surface nodes, mid-side ones too, moved to the fitted surfaces, which changes the shape alone. Where the fitted surfaces
# cannot be meshed the table ends there, with the reason and the status of tetmesh. Files and the table go to REFIT_RUN.
MSH ?=
MU ?=
KAPPA ?=
PRESSURE ?=
REFIT_SPACING ?=
REFIT_SIZE ?=
REFIT_CREST ?= 2.4
REFIT_ELEMENT ?= tet10-blend
REFIT_RUN ?= run/refit
.PHONY: refit
refit: $(addprefix $B/bin/,surfgen tetmesh fesolve) $B/tests/lib/mesh_skin ## a body given as a mesh, fitted, meshed and solved anew: MSH=FILE.msh MU=MPA PRESSURE=MPA [KAPPA=MPA]
	@BIN='$(BIN)' LIB='$B/tests/lib' SPACING='$(REFIT_SPACING)' SIZE='$(REFIT_SIZE)' CREST='$(REFIT_CREST)' \
		ELEMENT='$(REFIT_ELEMENT)' RUN='$(REFIT_RUN)' pipelines/refit.sh '$(MSH)' '$(MU)' '$(KAPPA)' '$(PRESSURE)'
