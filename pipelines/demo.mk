# The demonstration: builds everything, optimises a two-chamber robot for a few iterations, reports and draws. A stopped
# demo goes on where it was.
DEMO_CASE ?= data/cases/2A0R2T.ini
DEMO_SIZE ?= 5
DEMO_SET ?=
DEMO_ITERATIONS ?= 6
DEMO_RUN ?= run/demo
DEMO = +@$(MAKE) --no-print-directory $(JOBS) RUN=$(DEMO_RUN)
.PHONY: demo
demo: all ## the demonstration: optimise a small robot in a few minutes, report, draw
	$(DEMO) optimize CASE=$(DEMO_CASE) SIZE=$(DEMO_SIZE) SET='$(DEMO_SET)' ITERATIONS=$(DEMO_ITERATIONS)
	$(DEMO) pictures
	$(DEMO) report
