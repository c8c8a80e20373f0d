# pneumorph: build, dependencies, demo, tests. `make help` lists the targets.
.SUFFIXES:
.DELETE_ON_ERROR:
SHELL = /bin/bash

VERSION := $(shell cat VERSION)
PREFIX ?= /usr/local
DESTDIR ?=
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

WARN := -Wall -Wextra -Wshadow -Wconversion -Wcast-qual -Wwrite-strings -Wundef -Wvla -Wformat=2 \
	-Wstrict-prototypes -Wmissing-prototypes -Wdouble-promotion $(WERROR)
ALL_CFLAGS = -std=c17 -pedantic -D_POSIX_C_SOURCE=200809L -DPM_VERSION='"$(VERSION)"' $(WARN) \
	$(if $(ARCH),-march=$(ARCH)) -fno-math-errno -ffp-contract=off $(CFLAGS) $(SANFLAGS) -I. -isystem /usr/include/suitesparse \
	$(patsubst -I%,-isystem %,$(HDF5_CFLAGS)) $(CPPFLAGS)
LIBS = $(HDF5_LIBS) -lcholmod -lmetis -lopenblas -lgsl -llbfgs -linih -lz -lm
LIBS_tetmesh = -lgmsh

TOOLS := $(patsubst tools/%/main.c,%,$(wildcard tools/*/main.c))
COMMON_SRC := $(wildcard common/*/*.c)
COMMON_OBJ := $(COMMON_SRC:%.c=$B/%.o)
TOOL_BIN := $(TOOLS:%=$B/bin/%)
TEST_SRC := $(wildcard tests/unit/*.c tests/derivative/*.c tests/verify/*.c tests/fault/*.c)
TEST_BIN := $(TEST_SRC:%.c=$B/%)
# A test may use the kernels of a tool: every object of a tool but main.o, gathered without gmsh's users.
KERNEL_SRC := $(filter-out %/main.c tools/tetmesh/volume_gmsh.c,$(wildcard tools/*/*.c))

.PHONY: all
all: $(TOOL_BIN)

# Changed flags rebuild everything.
$B/flags: FORCE
	@mkdir -p $B; echo '$(CC) $(ALL_CFLAGS) $(LDFLAGS) $(LIBS)' | cmp -s - $@ || echo '$(CC) $(ALL_CFLAGS) $(LDFLAGS) $(LIBS)' > $@
FORCE:

$B/%.o: %.c $B/flags
	@mkdir -p $(@D)
	$(CC) $(ALL_CFLAGS) -MMD -MP -c $< -o $@

$B/libpneumorph.a: $(COMMON_OBJ)
	@rm -f $@; $(AR) rcs $@ $^

define tool_rule
$B/bin/$(1): $(patsubst %.c,$B/%.o,$(wildcard tools/$(1)/*.c)) $B/libpneumorph.a
	@mkdir -p $$(@D)
	$$(CC) $$(ALL_CFLAGS) $$(LDFLAGS) $$^ $$(LIBS_$(1)) $$(LIBS) -o $$@
endef
$(foreach t,$(TOOLS),$(eval $(call tool_rule,$(t))))

$B/libkernels.a: $(KERNEL_SRC:%.c=$B/%.o)
	@rm -f $@; $(AR) rcs $@ $^

$B/tests/%: $B/tests/%.o $B/libkernels.a $B/libpneumorph.a
	$(CC) $(ALL_CFLAGS) $(LDFLAGS) $^ $(LIBS) -lcjson -o $@
.PRECIOUS: $B/%.o

-include $(COMMON_OBJ:.o=.d) $(wildcard $B/tools/*/*.d $B/tests/*/*.d)

.PHONY: FORCE
