"""Words that gave way to those of the field do not come back: as names of files, types, functions."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SUFFIXES = {".py", ".pyi", ".hpp", ".cpp", ".md", ".txt"}
NEW_WORDS = dict(
    line.split()
    for line in """
arc_bound error_bound
axis_bound arc_error_bound
bind_seed_skeleton bind_sampled_skeleton
border_graph boundary_graph
border_rings boundary_rings
cell_borders half_edges
cell_tree hot_pixel_tree
clearance_level level_set
column_list column_envelope
common_circle ties
common_lattice dyadic_grid
coordinate_steps coordinate_compression
core_chains two_core
corner_line corner_bisector
delaunay_mesh delaunay_triangulation
delaunay_ties cocircular_ties
descents level_crossings
disc_cover disc_union
disc_domination disc_enlargement
edge_samples boundary_samples
exact_contacts contact_order
extract_seed_skeleton extract_sampled_skeleton
far_regions outer_components
format_columns format_rows
ghost_mesh insertion_mesh
idle_sides unwanted_sides
insertion_order brio
insertion_rounds parallel_insertion
lattice_crossing rational_point
live_columns active_column_arrays
live_list active_columns
local_insertion point_insertion
near_regions inner_components
nested_roots sqrt_tower
offset_domain polygon_faces
page_advice memory_release
placed_rings lattice_rings
planar_faces faces
point_order spatial_sort
polished_disc refined_disc
predicate_levels predicates
rectilinear_sweep rectilinear_intersections
root_tower sqrt_tower
seed_arcs sample_arcs
seed_crossings boundary_crossings
seed_diagram sample_diagram
seed_faces sample_faces
seed_groups sample_groups
SeedLabels SampleLabels
seed_mesh sample_mesh
seed_skeleton sampled_skeleton
seed_vector sample_vector
segment_exact exact_signs
segment_predicates insertion_predicates
segment_sweep segment_intersections
shape_graph planar_graph_view
site_hierarchy obb_tree
site_tree kd_tree
skeleton_contours contour_walk
skeleton_elements shortened_edges
skeleton_forest pendant_trees
skeleton_places nearest_point
surrounded_seeds interior_seeds
text_columns csv_columns
text_records csv_records
touched_ends ties
triangle_mesh flip_mesh
triangle_rings vertex_triangles
used_polygons repaired_polygons
verify_labels verify_tessellation
vertex_numbers vertex_merging
wide_integer fixed_integer
""".splitlines()
    if line
)


def in_capitals(word):
    """The name of a type that is called like a file."""
    return "".join(part[:1].upper() + part[1:] for part in word.split("_"))


NEW_NAMES = NEW_WORDS | {in_capitals(old): in_capitals(new) for old, new in NEW_WORDS.items()}
OLD_NAME = re.compile(rf"(?<![A-Za-z0-9_])(?:test_|bind_)?({'|'.join(NEW_NAMES)})_?(?![A-Za-z0-9_])")


def retired(text):
    """What a text should say instead of each retired word in it."""
    return sorted({f"{old} is now {NEW_NAMES[old]}" for old in OLD_NAME.findall(text)})


def sources():
    """All files of the repository that are written by hand, but the changelog and this one."""
    for folder in ("src", "tests", "docs"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in SUFFIXES and path != Path(__file__):
                yield path
    yield from (ROOT / name for name in ("Makefile", "README.md", "figures.mk", "pyproject.toml"))


@pytest.mark.parametrize(
    ("text", "instead"),
    [
        ("GhostMesh mesh(points);", ["GhostMesh is now InsertionMesh"]),
        ("core/spatial/site_tree.hpp", ["site_tree is now kd_tree"]),
        ("tests/core/test_live_list.py", ["live_list is now active_columns"]),
        ("descents_.place(h)", ["descents is now level_crossings"]),
        ("InsertionMesh, seed_labels, my_site_trees", []),
    ],
)
def test_the_search_finds_names_and_only_whole_ones(text, instead):
    assert retired(text) == instead


def test_new_words_are_not_retired_themselves():
    assert not [new for new in NEW_NAMES.values() if retired(new)]


def test_retired_words_do_not_return():
    found = [
        f"{path.relative_to(ROOT)}: {word}"
        for path in sources()
        for word in retired(f"{path.relative_to(ROOT)}\n{path.read_text()}")
    ]
    assert len(list(sources())) > 500
    assert not found, "\n".join(found)


def test_the_glossary_is_in_order_and_has_each_term_once():
    rows = [line.split("|")[1:-1] for line in (ROOT / "docs/glossary.md").read_text().splitlines() if "|" in line][2:]
    terms = [term.strip().casefold().replace("-", " ") for term, _ in rows]
    assert len(terms) > 40
    assert terms == sorted(set(terms))
    assert all(meaning.strip().endswith(".") for _, meaning in rows)
