"""Pictures of cameras and other programs as inputs of all commands."""

import numpy as np
import pytest
from PIL import Image

MASK = np.zeros((64, 96), np.uint8)
MASK[8:40, 8:40] = MASK[16:56, 56:88] = 255


@pytest.fixture
def photographs(folder):
    """One scene as each kind of file, noise and colors in those that may have them."""
    noise = np.random.default_rng(1).integers(-20, 21, (*MASK.shape, 3))
    photo = Image.fromarray(np.clip(MASK[:, :, None] + noise, 0, 255).astype(np.uint8))
    photo.save(folder / "a.jpg", quality=95)
    photo.save(folder / "a.webp", quality=95)
    for fmt in ("bmp", "gif", "png"):
        Image.fromarray(MASK).save(folder / f"a.{fmt}")
    return folder


@pytest.mark.parametrize(
    ("command", "name"),
    [
        ("tessellate -f npy", "a.jpg"),
        ("delaunay --what table -f csv", "a.webp"),
        ("alphashape -f csv", "a.bmp"),
        ("skeleton-exact -f csv", "a.gif"),
        ("skeleton-approx --step 5 -f csv", "a.jpg"),
    ],
)
@pytest.mark.filterwarnings("ignore::vorotool.errors.VorotoolWarning")
def test_a_threshold_makes_the_mask_of_a_photograph(run, photographs, command, name):
    """Each command gives the same as of the mask itself."""
    for source in ("a.png", name):
        run(f"{command} {source} --threshold otsu -q -o {source}.out")
    assert (photographs / "a.png.out").read_bytes() == (photographs / f"{name}.out").read_bytes()


def test_photographs_need_a_threshold(run, photographs):
    Image.open(photographs / "a.jpg").convert("L").save(photographs / "grey.jpg")
    for name, reason in (("a.jpg", "a color image"), ("grey.jpg", "not labels")):
        run(f"tessellate {name} -o b.npy", code=3, says=[f"error: {name}: ", reason, "--threshold otsu"])
    run("draw grey.jpg -o b.svg", code=3, says="give a PNG, TIFF or NPY file")


@pytest.mark.parametrize("columns", [3, 4])
def test_points_with_further_columns_are_no_photograph(run, folder, columns):
    np.save(folder / "a.npy", np.random.default_rng(1).random((30, columns)))
    run("delaunay a.npy", code=3, says=f"(30, {columns}), is it a list of points?")


def test_the_first_picture_of_an_animation_is_read_with_a_note(run, photographs):
    frames = [Image.fromarray(part) for part in (MASK, 255 - MASK)]
    frames[0].save(photographs / "b.gif", save_all=True, append_images=frames[1:])
    run("tessellate b.gif -o first.npy", says="--page")
    run("tessellate a.png -o mask.npy")
    assert (photographs / "first.npy").read_bytes() == (photographs / "mask.npy").read_bytes()
    assert "pictures" not in run("tessellate b.gif --page 1 -o second.npy").err
    assert (photographs / "second.npy").read_bytes() != (photographs / "mask.npy").read_bytes()


@pytest.mark.parametrize("name", ["a.jpg", "a.webp", "a.bmp", "a.gif"])
def test_damaged_pictures_are_refused_by_name(run, photographs, name):
    data = (photographs / name).read_bytes()
    for part in (b"", data[:10], data[: len(data) // 2]):
        (photographs / name).write_bytes(part)
        run(f"tessellate {name} -o out.npy --threshold 9", code=3, says=name)
    (photographs / name).write_bytes(data)
    run(f"tessellate {name} -o c.npy --threshold 9 --max-pixels 6143", code=5)


@pytest.mark.parametrize(
    ("columns", "top", "is_said"), [(4, 500, True), (3, 500, True), (4, 2, False), (5, 500, False)]
)
def test_integers_that_may_be_points_are_said_to_be_an_image(run, folder, columns, top, is_said):
    np.save(folder / "a.npy", np.random.default_rng(1).integers(0, top, (30, columns)))
    said = "save x and y alone, with shape (n, 2)"
    assert (said in run("tessellate a.npy -o b.npy").err) == is_said
    assert (said in run("info a.npy").out) == is_said
