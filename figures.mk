# Figures and tables of the paper: one rule each, its body a vorotool pipeline.
# `make figures` draws all, `make figure-01` one; they go to build/figures.
VOROTOOL := $(BIN)/vorotool
FIGURES  := $(BUILD)/figures
TABLE_1_SIZES := 64 128 256 512

.PHONY: figures figure-01 figure-02 figure-03a figure-03b figure-03c figure-03d figure-04a figure-04b figure-04c table-1
figures: figure-01 figure-02 figure-03a figure-03b figure-03c figure-03d figure-04a figure-04b figure-04c table-1 ## draw the figures and tables of the paper into build/figures
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
