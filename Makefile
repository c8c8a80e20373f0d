# pneumorph: build, dependencies, demo, tests. `make help` lists the targets.
.SUFFIXES:
.DELETE_ON_ERROR:
SHELL = /bin/bash

VERSION := $(shell cat VERSION)
PREFIX ?= /usr/local
DESTDIR ?=
DEPS ?=
CC ?= cc
ARCH ?= native
CFLAGS ?= -O3
WERROR ?=
# SANITIZE=1 builds to build-sanitize/ with the address and undefined behaviour sanitizers.
SANITIZE ?=
B := build
ifneq ($(SANITIZE),)
B := build-sanitize
SANFLAGS := -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer -g
endif

PKG_CONFIG ?= pkg-config
HDF5_CFLAGS := $(shell $(PKG_CONFIG) --cflags hdf5-serial 2>/dev/null || $(PKG_CONFIG) --cflags hdf5 2>/dev/null)
HDF5_LIBS := $(shell $(PKG_CONFIG) --libs hdf5-serial 2>/dev/null || $(PKG_CONFIG) --libs hdf5 2>/dev/null) 

# Vectors of eight doubles go between our own functions alone, all compiled alike: no ABI to keep.
WARN := -Wno-psabi -Wall -Wextra -Wshadow -Wconversion -Wcast-qual -Wwrite-strings -Wundef -Wvla -Wformat=2 \
	-Wstrict-prototypes -Wmissing-prototypes -Wdouble-promotion $(WERROR)
ALL_CFLAGS = -std=c17 -pedantic -D_POSIX_C_SOURCE=200809L -DPM_VERSION='"$(VERSION)"' $(WARN) \
	$(if $(ARCH),-march=$(ARCH)) -fno-math-errno -ffp-contract=fast $(CFLAGS) $(SANFLAGS) -I. -isystem /usr/include/suitesparse \
	$(patsubst -I%,-isystem %,$(HDF5_CFLAGS)) $(CPPFLAGS)
LIBS = $(HDF5_LIBS) -lcholmod -lmetis -lopenblas -lgsl -llbfgs -linih -lz -lm
LIBS_tetmesh = -lgmsh
LIBS_lib/gmsh_body = -lgmsh

TOOLS := $(patsubst tools/%/main.c,%,$(wildcard tools/*/main.c))
COMMON_SRC := $(wildcard common/*/*.c)
COMMON_OBJ := $(COMMON_SRC:%.c=$B/%.o)
TOOL_BIN := $(TOOLS:%=$B/bin/%)
TEST_SRC := $(wildcard tests/unit/*.c tests/derivative/*.c tests/verify/*.c tests/fault/*.c)
TEST_BIN := $(TEST_SRC:%.c=$B/%)
# A test may use the kernels of a tool: every object of a tool but main.o, gathered without gmsh's users.
KERNEL_SRC := $(filter-out %/main.c tools/tetmesh/volume_gmsh.c,$(wildcard tools/*/*.c))

# The flags of HDF5 are read when make starts: what may install packages first goes through a second make.
# All processors where the caller asks for no number of jobs.
JOBS = $(if $(filter -j% --jobserver%,$(MAKEFLAGS)),,-j$(shell nproc))
.PHONY: all build deps deps-lint
all: deps ## build the tools to build/bin (installs missing packages first, DEPS=no: does not)
	+@$(MAKE) --no-print-directory $(JOBS) build
build: $(TOOL_BIN)
deps: ## install the Debian packages that are missing
	@DEPS='$(DEPS)' ./deps.sh build
deps-lint:
	@DEPS='$(DEPS)' ./deps.sh lint

# Changed flags rebuild everything.
$B/flags: FORCE
	@mkdir -p $B; echo '$(CC) $(ALL_CFLAGS) $(LDFLAGS) $(LIBS)' | cmp -s - $@ || echo '$(CC) $(ALL_CFLAGS) $(LDFLAGS) $(LIBS)' > $@
FORCE:

$B/%.o: %.c $B/flags
	@mkdir -p $(@D)
	$(CC) $(ALL_CFLAGS) -MMD -MP -c $< -o $@

# A file that came or went makes the archives anew.
$B/sources: FORCE
	@mkdir -p $B; echo '$(COMMON_SRC) $(KERNEL_SRC)' | cmp -s - $@ || echo '$(COMMON_SRC) $(KERNEL_SRC)' > $@

$B/libpneumorph.a: $(COMMON_OBJ) $B/sources
	@rm -f $@; $(AR) rcs $@ $(COMMON_OBJ)

define tool_rule
$B/bin/$(1): $(patsubst %.c,$B/%.o,$(wildcard tools/$(1)/*.c)) $B/libpneumorph.a
	@mkdir -p $$(@D)
	$$(CC) $$(ALL_CFLAGS) $$(LDFLAGS) $$^ $$(LIBS_$(1)) $$(LIBS) -o $$@
endef
$(foreach t,$(TOOLS),$(eval $(call tool_rule,$(t))))

KERNEL_OBJ := $(KERNEL_SRC:%.c=$B/%.o)
$B/libkernels.a: $(KERNEL_OBJ) $B/sources
	@rm -f $@; $(AR) rcs $@ $(KERNEL_OBJ)

$B/tests/%: $B/tests/%.o $B/libkernels.a $B/libpneumorph.a
	$(CC) $(ALL_CFLAGS) $(LDFLAGS) $^ $(LIBS_$*) $(LIBS) -lcjson -o $@
.PRECIOUS: $B/%.o

-include $(COMMON_OBJ:.o=.d) $(wildcard $B/tools/*/*.d $B/tests/*/*.d)

# Tests: C programs and shell scripts that print TAP. `make check T='tests/unit/records.c'` runs some.
TEST_SH := $(wildcard tests/cli/*.sh tests/verify/*.sh tests/pipeline/*.sh)
TEST_TOOL := $(patsubst tests/lib/%.c,$B/tests/lib/%,$(wildcard tests/lib/*.c))
T ?= $(TEST_SRC) $(TEST_SH)
PROVE_JOBS ?= 2
RUN_TESTS = $(patsubst %.c,$B/%,$(filter %.c,$(T))) $(filter %.sh,$(T))
.PHONY: check check-built
check: deps ## build and run the tests (SANITIZE=1: under the address and undefined sanitizers)
	+@$(MAKE) --no-print-directory $(JOBS) check-built
check-built: $(TOOL_BIN) $(TEST_TOOL) $(filter $B/%,$(RUN_TESTS))
	BUILD='$B' prove -j$(PROVE_JOBS) $(RUN_TESTS)

# Studies of minutes to an hour.
.PHONY: check-long
check-long: deps ## the long tests: tests/long/*.sh
	+@$(MAKE) --no-print-directory $(JOBS) check-built T='$(wildcard tests/long/*.sh)'

# Checks of the source text.
C_FILES := $(wildcard common/*/*.[ch] tools/*/*.[ch] tests/*.[ch] tests/*/*.[ch])
SH_FILES := $(wildcard *.sh .ci/run pipelines/*.sh tests/*.sh tests/*/*.sh)
.PHONY: lint lint-text format
lint: deps deps-lint ## clang-format, clang-tidy, cppcheck, shellcheck, mandoc, sizes
	+@$(MAKE) --no-print-directory lint-text
TIDY_FLAGS = -std=c17 -D_POSIX_C_SOURCE=200809L -DPM_VERSION="\"\"" -I. $(patsubst -I%,-isystem %,$(HDF5_CFLAGS)) -isystem /usr/include/suitesparse
lint-text:
	clang-format --dry-run -Werror $(C_FILES)
	@awk 'FNR == 601 { print FILENAME ": more than 600 lines"; bad = 1 } END { exit bad }' $(C_FILES)
	@! grep -nE '\b(atoi|atof|sprintf|strcpy|strcat)\(' $(C_FILES)
	@for h in hdf5 cholmod metis gmshc ini zlib lbfgs; do \
		grep -lx "#include <$$h.h>" $(filter-out tests/%,$(C_FILES)) | awk -v h="$$h.h" 'END { if (NR != 1) { print h ": " NR " users, expected 1"; exit 1 } }' || exit 1; \
	done
	cppcheck --quiet --std=c11 --enable=warning,performance,portability --inline-suppr --error-exitcode=1 \
		--suppress=missingIncludeSystem -I. -DPM_VERSION='""' common tools
	printf '%s\n' $(filter %.c,$(C_FILES)) | xargs -P 2 -n 4 sh -c 'clang-tidy --quiet "$$@" -- $(TIDY_FLAGS) 2>/dev/null' sh
	shellcheck -x -S warning $(SH_FILES)
	mandoc -Tlint -Wwarning $(wildcard man/*.[1-9])
format: ## lay out the C files with clang-format
	clang-format -i $(C_FILES)

# The list of items in the format page is the schema table.
.PHONY: format-page
format-page: $B/tests/lib/schema_page ## update the list of items in man/pneumorph-format.5
	awk '/^\.\\" schema end/ { while (("$<" | getline line) > 0) print line; skip = 0 } !skip; /^\.\\" schema begin/ { skip = 1 }' \
		man/pneumorph-format.5 > $B/page && cp $B/page man/pneumorph-format.5

.PHONY: install uninstall clean help
CASES := $(wildcard data/cases/*.ini)
BODIES := $(wildcard data/bodies/*.geo)
MAN_PAGES := $(wildcard man/*.[1-9])
share = $(DESTDIR)$(PREFIX)/share
install: build ## install tools, pages and cases under $(DESTDIR)$(PREFIX)
	install -d $(DESTDIR)$(PREFIX)/bin $(share)/pneumorph/cases $(share)/pneumorph/bodies
	install -m 755 $(TOOL_BIN) $(DESTDIR)$(PREFIX)/bin
	install -m 644 $(CASES) $(share)/pneumorph/cases
	install -m 644 $(BODIES) $(share)/pneumorph/bodies
	for page in $(MAN_PAGES); do install -D -m 644 -t $(share)/man/man$${page##*.} $$page || exit 1; done
uninstall: ## remove what install wrote
	rm -f $(TOOLS:%=$(DESTDIR)$(PREFIX)/bin/%)
	for page in $(MAN_PAGES); do rm -f $(share)/man/man$${page##*.}/$${page##*/}; done
	rm -rf $(share)/pneumorph
clean: ## remove the build folders
	rm -rf build build-*
help: ## this list
	@sed -n 's/^\([a-z][a-z-]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | sort | awk -F '\t' '{ printf "%-12s %s\n", $$1, $$2 }'

include $(wildcard pipelines/*.mk)

.PHONY: FORCE
