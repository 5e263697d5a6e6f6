# Figures and tables of the paper: one rule each, its body a vorotool pipeline.
# `make figures` draws all, `make figure-01` one; they go to build/figures.
VOROTOOL := $(BIN)/vorotool
FIGURES  := $(BUILD)/figures
TABLE_1_SIZES := 64 128 256 512
FIGURE_9_STEPS := 20 15 10 5

.PHONY: figures figure-01 figure-02 figure-03a figure-03b figure-03c figure-03d figure-04a figure-04b figure-04c figure-05 figure-06 figure-07 figure-08 figure-09 figure-10 figure-11 figure-lakes table-1
figures: figure-01 figure-02 figure-03a figure-03b figure-03c figure-03d figure-04a figure-04b figure-04c figure-05 figure-06 figure-07 figure-08 figure-09 figure-10 figure-11 figure-lakes table-1 ## draw the figures and tables of the paper into build/figures
	@echo "figures are in $(FIGURES):" && ls $(FIGURES)
figure-01: $(FIGURES)/figure-01.svg
figure-02: $(FIGURES)/figure-02.svg
figure-03a: $(FIGURES)/figure-03a.png
figure-03b: $(FIGURES)/figure-03b.svg
figure-03c: $(FIGURES)/figure-03c.svg
figure-03d: $(FIGURES)/figure-03d.svg
figure-04a: $(FIGURES)/figure-04a.svg
figure-04b: $(FIGURES)/figure-04b.svg
figure-04c: $(FIGURES)/figure-04c.svg
figure-05: $(foreach part,a b c d,$(FIGURES)/figure-05$(part).svg)
figure-06: $(FIGURES)/figure-06.svg
figure-07: $(FIGURES)/figure-07.svg
figure-08: $(FIGURES)/figure-08.svg
figure-09: $(foreach step,$(FIGURE_9_STEPS),$(FIGURES)/figure-09-$(step).svg)
figure-10: $(FIGURES)/figure-10.svg
figure-11: $(foreach part,a b c d,$(FIGURES)/figure-11$(part).svg)
figure-lakes: $(FIGURES)/figure-lakes.png
table-1: $(FIGURES)/table-1.md

$(FIGURES):
	mkdir -p $@

# Purpose: the matrix V of six seeds after the first passes of section 2.2.
$(FIGURES)/figure-01.svg: data/six-seeds.csv $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) tessellate $< --size 16x16 --method propagation --passes 1 -o $@

# Purpose: the digital Voronoi tessellation of the same seeds, after the second passes.
$(FIGURES)/figure-02.svg: data/six-seeds.csv $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) tessellate $< --size 16x16 --method propagation -o $@

# Purpose: the digital Voronoi diagram of 53 random seeds.
$(FIGURES)/figure-03a.png: data/dots.csv $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) tessellate $< --size 512x512 --what diagram --layers diagram,seeds -o $@

# Purpose: the continuous Voronoi diagram of the same seeds, in the same image.
$(FIGURES)/figure-03b.svg: data/dots.csv $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) delaunay $< --what cells --frame -0.5,-0.5,512,512 --layers diagram,points -o $@

# Purpose: the Delaunay triangulation of the same seeds as their digital diagram shows it.
$(FIGURES)/figure-03c.svg: data/dots.csv $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) delaunay $< --size 512x512 --method digital -o $@

# Purpose: the Delaunay triangulation of the same seeds, from the continuous diagram.
$(FIGURES)/figure-03d.svg: data/dots.csv $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) delaunay $< -o $@

# Purpose: a dot pattern of 160 random seeds,
$(FIGURES)/figure-04a.svg: data/dot-pattern.csv $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) delaunay $< --layers points -o $@

# the edges of its Delaunay triangulation,
$(FIGURES)/figure-04b.svg: data/dot-pattern.csv $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) delaunay $< --layers edges,points -o $@

# and its alpha shape for r = -1/α = 10.
$(FIGURES)/figure-04c.svg: data/dot-pattern.csv $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) alphashape $< -r 10 -o $@

# Purpose: line segments, their samples (the step is 2), the Voronoi diagram of these, and what is left of it.
$(FIGURES)/figure-05a.svg: data/segments.wkt $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-approx $< --step 2 --side exterior --what elements --layers polygons -o $@
$(FIGURES)/figure-05b.svg: data/segments.wkt $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-approx $< --step 2 --side exterior --what elements --layers points -o $@
$(FIGURES)/figure-05c.svg: data/segments.wkt $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-approx $< --step 2 --what diagram --layers points,skeleton -o $@
$(FIGURES)/figure-05d.svg: data/segments.wkt $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-approx $< --step 2 --side exterior -o $@

# Purpose: the bisector of two line segments, of straight lines, parabolas and half lines.
$(FIGURES)/figure-06.svg: data/two-segments.wkt $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --side exterior -o $@

# Purpose: the bisector of a point and a segment (broken), and the Voronoi diagram of samples.
$(FIGURES)/figure-07.svg: data/point-and-segment.json $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-approx $< --step 20 --side exterior --what diagram --layers elements,points,skeleton,exact --y-up -o $@

# Purpose: the straight bisector of two segments (broken), and the Voronoi diagram of samples.
$(FIGURES)/figure-08.svg: data/two-segments.wkt $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-approx $< --step 20 --side exterior --what diagram --layers elements,points,skeleton,exact -o $@

# Purpose: the approximate bisector of the same segments for several steps, and the exact one (broken).
$(FIGURES)/figure-09-%.svg: data/two-segments.wkt $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-approx $< --step $* --side exterior --layers polygons,points,skeleton,exact -o $@

# Purpose: the elements of a polygonal shape, one label for an edge and two for a vertex.
$(FIGURES)/figure-10.svg: data/shape.json $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --gap 4 --what elements --layers elements,points,labels -o $@

# Purpose: two polygonal shapes, their elements (the step is 4), the Voronoi diagram of these, and the skeletons.
$(FIGURES)/figure-11a.svg: data/two-shapes.json $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --what elements --layers polygons -o $@
$(FIGURES)/figure-11b.svg: data/two-shapes.json $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --gap 4 --what elements --layers elements,points -o $@
$(FIGURES)/figure-11c.svg: data/two-shapes.json $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --gap 4 --what diagram -o $@
$(FIGURES)/figure-11d.svg: data/two-shapes.json $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --gap 4 -o $@

# Purpose: the exact skeletons of real polygons, with islands as holes.
$(FIGURES)/figure-lakes.png: data/great-lakes.geojson $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< -q -o $@

# Purpose: seconds against the size of the image: the paper's, its algorithm here, and the exact engine.
# The 53 seeds of Figure 3 are scaled to each size.
$(FIGURES)/table-1.md: data/dots.csv docs/table_1.py $(BUILD)/.installed | $(FIGURES)
	mkdir -p $(BUILD)/table-1
	for m in $(TABLE_1_SIZES); do for method in propagation exact; do \
	    awk -F, -v m=$$m 'NR == 1 { print; next } { print int($$1 * m / 512) "," int($$2 * m / 512) }' $< \
	    | $(VOROTOOL) tessellate - --size $${m}x$${m} --method $$method --threads 1 -q -o $(BUILD)/table-1/labels.npy \
	      --stats $(BUILD)/table-1/$$method-$$m.json || exit 1; \
	done; done
	$(RUN) docs/table_1.py $(BUILD)/table-1 $(TABLE_1_SIZES) > $@
	cat $@
