# Figures and tables of the paper: one rule each, its body a vorotool pipeline.
# `make figures` draws all, `make figure-01` one; they go to build/figures.
VOROTOOL := $(BIN)/vorotool
FIGURES  := $(BUILD)/figures
GALLERY  := $(BUILD)/gallery
TABLE_1_SIZES := 64 128 256 512
FIGURE_9_STEPS := 20 15 10 5
GALLERY_PICTURES := letters-all.svg letters.svg letters-angle.svg vessels.png vessels.csv river.svg widths.svg \
                    silhouettes.svg silhouettes-chord.svg silhouettes.csv slider.html lakes.svg offsets.svg \
                    cells.svg outside.svg alpha.svg houses.svg territories.svg nuclei.svg thickness.png \
                    thickness-dark.png discs.svg parts.svg sociology.svg sociology.csv colonies.svg persistence.svg \
                    strokes.svg strokes-dark.svg knot.png knot.html

NAMES := figure-01 figure-02 figure-03a figure-03b figure-03c figure-03d figure-04a figure-04b figure-04c \
         figure-05 figure-06 figure-07 figure-08 figure-09 figure-10 figure-11 figure-lakes table-1 error-vs-h

.PHONY: figures paper gallery $(NAMES)
paper: $(NAMES)
figures: paper gallery ## draw the figures and tables of the paper, and the gallery, into build/figures
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
gallery: $(addprefix $(FIGURES)/gallery-,$(GALLERY_PICTURES)) ## draw the pictures of docs/gallery.md
error-vs-h: $(FIGURES)/error-vs-h.md

$(FIGURES) $(GALLERY):
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
$(FIGURES)/table-1.md: data/dots.csv docs/scripts/table_1.py $(BUILD)/.installed | $(FIGURES)
	mkdir -p $(BUILD)/table-1
	for m in $(TABLE_1_SIZES); do for method in propagation exact; do \
	    awk -F, -v m=$$m 'NR == 1 { print; next } { print int($$1 * m / 512) "," int($$2 * m / 512) }' $< \
	    | $(VOROTOOL) tessellate - --size $${m}x$${m} --method $$method --threads 1 -q -o $(BUILD)/table-1/labels.npy \
	      --stats $(BUILD)/table-1/$$method-$$m.json || exit 1; \
	done; done
	$(RUN) docs/scripts/table_1.py $(BUILD)/table-1 $(TABLE_1_SIZES) > $@
	cat $@

# ---- the picture of the README -------------------------------------------------------------------------------------
FRONT_FOLDER  := $(BUILD)/front
FRONT_PICTURE := docs/images/front.svg
FRONT := $(addprefix $(FRONT_FOLDER)/,cells.svg regions.svg skeletons.svg offsets.svg)
.PHONY: front
front: $(FRONT) docs/scripts/front_picture.py ## draw docs/images/front.svg, the picture of the README, anew
	$(RUN) docs/scripts/front_picture.py $(FRONT) > $(FRONT_PICTURE)

$(FRONT_FOLDER)/cells.svg: data/dots.csv $(BUILD)/.installed
	@mkdir -p $(@D)
	$(VOROTOOL) delaunay $< --what cells --frame -0.5,-0.5,512,512 --layers cells,diagram,points -o $@
$(FRONT_FOLDER)/regions.svg: data/blobs.png $(BUILD)/.installed
	@mkdir -p $(@D)
	$(VOROTOOL) tessellate $< --what color --layers cells --overlay $< -o $@
$(FRONT_FOLDER)/skeletons.svg: data/two-shapes.json $(BUILD)/.installed
	@mkdir -p $(@D)
	$(VOROTOOL) skeleton-exact $< -o $@
$(FRONT_FOLDER)/offsets.svg: data/two-shapes.json $(BUILD)/.installed
	@mkdir -p $(@D)
	$(VOROTOOL) skeleton-exact $< --what offset -d -20,-10,10,20 -o $@

# ---- gallery: docs/gallery.md shows these, each with its command ---------------------------------------------------
$(GALLERY)/%.png: docs/scripts/gallery_inputs.py $(BUILD)/.installed | $(GALLERY)
	$(RUN) $< $* > $@

# Purpose: the exact skeleton of letters in pixels: each corner of a pixel has its branch.
$(FIGURES)/gallery-letters-all.svg: $(GALLERY)/letters.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --prune none -o $@

# Purpose: the same as masks are pruned by default, by scale: the ends of strokes stay.
$(FIGURES)/gallery-letters.svg: $(GALLERY)/letters.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< -o $@

# Purpose: the same, pruned by the angle under which centers see the boundary: no branch to a corner.
$(FIGURES)/gallery-letters-angle.svg: $(GALLERY)/letters.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --prune angle=150 -o $@

# Purpose: the skeleton of a network over its image,
$(FIGURES)/gallery-vessels.png: $(GALLERY)/vessels.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --overlay $< -o $@

# Purpose: how thick it is, in colors: at each pixel the largest disc over it,
$(FIGURES)/gallery-thickness.png: $(GALLERY)/vessels.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --what thickness --legend -o $@

# Purpose: and on dark ground.
$(FIGURES)/gallery-thickness-dark.png: $(GALLERY)/vessels.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --what thickness --legend --background "#1c1c1c" -o $@

# Purpose: and the length and the radii of its branches.
$(FIGURES)/gallery-vessels.csv: $(GALLERY)/vessels.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --what branches -o $@

# Purpose: a centerline, from bank to bank past two islands.
$(FIGURES)/gallery-river.svg: $(GALLERY)/river.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --what centerline --prune ratio=2 -o $@

# Purpose: its width, across from foot to foot, at equal steps along the branches.
$(FIGURES)/gallery-widths.svg: $(GALLERY)/river.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --what transects --every 24 --prune ratio=2 -o $@

# Purpose: strokes of a drawing to their ends, as smooth curves,
$(FIGURES)/gallery-strokes.svg: $(GALLERY)/strokes.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --ends middle --smooth 1 -o $@

# Purpose: and on dark ground.
$(FIGURES)/gallery-strokes-dark.svg: $(GALLERY)/strokes.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --ends middle --smooth 1 --background '#1c1c1c' --color polygons=#5a5a5a --color skeleton=#ffb000 -o $@

# Purpose: a label image: one object a label.
$(FIGURES)/gallery-silhouettes.svg: $(GALLERY)/silhouettes.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --prune ratio=1.5 -o $@

# Purpose: the same, pruned by the chord between the two nearest places on the boundary: by size in pixels.
$(FIGURES)/gallery-silhouettes-chord.svg: $(GALLERY)/silhouettes.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --prune chord=20 -o $@

# Purpose: the widths of these objects, and what their skeletons are made of.
$(FIGURES)/gallery-silhouettes.csv: $(GALLERY)/silhouettes.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --what table -o $@

# Purpose: a page with a slider for what is pruned.
$(FIGURES)/gallery-slider.html: $(GALLERY)/silhouettes.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --prune ratio=1.5 -o $@

# Purpose: a map: lakes with islands, pruned by scale.
$(FIGURES)/gallery-lakes.svg: data/great-lakes.geojson $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --prune scale=1.3 -q -o $@

# Purpose: the same lakes, and what is farther from the shore than four distances.
$(FIGURES)/gallery-offsets.svg: data/great-lakes.geojson $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --what offset -d -0.1,-0.2,-0.3,-0.4 -q -o $@

# Purpose: the same lakes, and the largest discs in them.
$(FIGURES)/gallery-discs.svg: data/great-lakes.geojson $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --what discs --count 40 -q -o $@

# Purpose: the same lakes, cut at their necks.
$(FIGURES)/gallery-parts.svg: data/great-lakes.geojson $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --what parts -q -o $@

# Purpose: labels that touch: each is an object of its own. The elements are the outlines.
$(FIGURES)/gallery-cells.svg: data/cells.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --prune chord=9 --layers polygons,elements,skeleton -o $@

# Purpose: the skeleton of what is outside: ways between objects.
$(FIGURES)/gallery-outside.svg: data/blobs.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) skeleton-exact $< --side exterior --prune angle=120 -o $@

# Purpose: the skeleton of the alpha shape of a dot pattern.
$(FIGURES)/gallery-alpha.svg: data/dot-pattern.csv $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) alphashape $< -r 10 --what polygons -f geojson -q -o - | $(VOROTOOL) skeleton-exact - --prune scale=1.2 -q -o $@

# Purpose: cells of buildings between streets: the generalized Voronoi diagram that section 1 asks for.
$(FIGURES)/gallery-houses.svg: data/houses.geojson data/streets.geojson $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) voronoi $< --enclosures data/streets.geojson --frame 20,14,336,200 --layers cells,objects -o $@

# Purpose: territories of nuclei up to 5 micrometres, with circular arcs.
$(FIGURES)/gallery-territories.svg: data/nuclei.ome.tif $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) voronoi $< --pixel-size auto --max-distance 5um --layers cells,objects -o $@

# Purpose: territories of nuclei in three dimensions: slices across z, x and y.
$(FIGURES)/gallery-nuclei.svg: data/nuclei.tif $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) tessellate $< --volume --spacing auto --max-distance 5um --what color --width 918 -o $@

# Purpose: the surface of a scanned knot, from its points alone.
$(FIGURES)/gallery-knot.png: data/knot.xyz $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) alphashape $< --space -r 1.3 --what surface --verify -o $@

# Purpose: a page that turns it, with a slider over all radii.
$(FIGURES)/gallery-knot.html: data/knot.xyz $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) alphashape $< --space -r 1.3 -o $@

# Purpose: cell sociology: the Voronoi cells of objects, relative neighbors,
$(FIGURES)/gallery-sociology.svg: data/blobs.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) delaunay $< --what cells --layers cells,edges,points --graph relative -o $@

# Purpose: and what their cells are like on the whole.
$(FIGURES)/gallery-sociology.csv: data/blobs.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) delaunay $< --what statistics -o $@

# Purpose: clusters of a dot pattern: the regions of one alpha shape,
$(FIGURES)/gallery-colonies.svg: $(GALLERY)/colonies.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) alphashape $< -r 30 --what polygons --layers polygons,points -o $@

# Purpose: and how long the regions of all shapes last.
$(FIGURES)/gallery-persistence.svg: $(GALLERY)/colonies.png $(BUILD)/.installed | $(FIGURES)
	$(VOROTOOL) alphashape $< --what persistence -q -o $@

# Purpose: the errors of section 3.1 against the step, measured and certified, beside the paper's estimates.
$(FIGURES)/error-vs-h.md: data/shape.json data/two-shapes.json data/two-segments.wkt docs/scripts/error_vs_h.py $(BUILD)/.installed | $(FIGURES)
	$(RUN) docs/scripts/error_vs_h.py $(FIGURES)/error-vs-h.svg > $@
	cat $@
