"""Draw the masks of the gallery: `docs/scripts/gallery_inputs.py NAME`, one PNG on standard output.

letters, vessels, river, colonies and strokes are masks; silhouettes are labels 1 to 3.
"""

import sys
from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

Places = NDArray[np.float64]
FINER = 4
"""Pictures are drawn so much larger, and made smaller by a majority of their pixels."""


class Canvas:
    """A mask on which discs and strokes are drawn in pixels."""

    def __init__(self, width: int, height: int) -> None:
        self.image = Image.new("L", (width * FINER, height * FINER))
        self.pen = ImageDraw.Draw(self.image)

    def disc(self, x: float, y: float, radius: float) -> None:
        """Fill a disc."""
        box = [(x - radius) * FINER, (y - radius) * FINER, (x + radius) * FINER, (y + radius) * FINER]
        self.pen.ellipse(box, fill=255)

    def stroke(self, places: Places, radius: Places) -> None:
        """Draw a line as wide as its discs are."""
        for (a, b), (r, s) in zip(pairwise(places), pairwise(radius), strict=True):
            steps = max(2, int(4 * np.hypot(*(b - a)) / min(r, s)))
            for t in np.linspace(0, 1, steps):
                self.disc(*(a + t * (b - a)).tolist(), float(r + t * (s - r)))

    def fill(self, places: Places) -> None:
        """Fill a polygon."""
        self.pen.polygon([tuple(place) for place in (places * FINER).tolist()], fill=255)

    def mask(self) -> NDArray[np.bool_]:
        """What more than half of each pixel is covered by."""
        small = self.image.resize((self.image.width // FINER, self.image.height // FINER), Image.Resampling.BOX)
        return np.asarray(small) > 127


def smooth(corners: Places, *, closed: bool = False) -> Places:
    """Round a polyline off: corners are cut (Chaikin 1974), five times."""
    for _ in range(5):
        following = np.roll(corners, -1, axis=0) if closed else corners[1:]
        first = corners if closed else corners[:-1]
        cut = np.stack([0.75 * first + 0.25 * following, 0.25 * first + 0.75 * following], axis=1).reshape(-1, 2)
        corners = cut if closed else np.concatenate([corners[:1], cut, corners[-1:]])
    return corners


def letters() -> NDArray[np.uint8]:
    """Three letters of Pillow's own typeface."""
    canvas = Canvas(900, 420)
    font = ImageFont.load_default(380 * FINER)
    canvas.pen.text((450 * FINER, 210 * FINER), "R&S", fill=255, font=font, anchor="mm")
    return canvas.mask().astype(np.uint8) * 255


def vessels() -> NDArray[np.uint8]:
    """Branch from two stems: thinner by Murray's law, the cube of a radius is the sum of those of its branches."""
    random = np.random.default_rng(2)
    canvas = Canvas(1000, 640)
    stems = [(-10.0, 330.0, 0.06, 19.0), (1010.0, 330.0, np.pi - 0.1, 15.0)]
    while stems:
        x, y, heading, radius = stems.pop()
        places = [(x, y)]
        for _ in range(int(3 + radius * 0.9)):
            heading += random.normal(0, 0.16)
            x, y = x + 14 * np.cos(heading), y + 14 * np.sin(heading)
            places.append((x, y))
        line = smooth(np.array(places))
        canvas.stroke(line, np.full(len(line), radius))
        if radius < 5 or not (-20 < x < 1020 and -20 < y < 660):
            continue
        share = random.uniform(0.35, 0.65)
        for part, turn in ((share, random.uniform(0.25, 0.7)), (1 - share, -random.uniform(0.25, 0.7))):
            stems.append((x, y, heading + turn, radius * part ** (1 / 3)))
    return canvas.mask().astype(np.uint8) * 255


def river() -> NDArray[np.uint8]:
    """Meander with two islands, wider downstream."""
    canvas = Canvas(1000, 420)
    t = np.linspace(0, 1, 400)
    x = 1040 * t - 20 + 26 * np.sin(17 * t)
    y = 210 + (40 + 105 * t * (1.1 - t) * 2) * np.sin(5.2 * np.pi * t + 0.6) * 0.9
    width = 12 + 20 * t + 5 * np.sin(31 * t) + 3 * np.sin(67 * t + 1)
    canvas.stroke(np.stack([x, y], axis=1), width)
    mask = canvas.mask()
    islands = Canvas(1000, 420)
    for at, long in ((215, 26), (330, 20)):
        heading = np.arctan2(y[at + 1] - y[at - 1], x[at + 1] - x[at - 1])
        way = np.array([np.cos(heading), np.sin(heading)])
        middle = np.array([x[at], y[at]])
        islands.stroke(np.stack([middle - long * way, middle, middle + long * way]), np.array([2.0, 9.0, 2.0]))
    return (mask & ~islands.mask()).astype(np.uint8) * 255


def hand() -> Canvas:
    """A palm, and five fingers."""
    canvas = Canvas(1000, 420)
    canvas.fill(
        smooth(
            np.array([[66, 205], [216, 205], [224, 330], [196, 432], [196, 450], [88, 450], [88, 432], [58, 310]]),
            closed=True,
        )
    )
    fingers = (
        ([[95, 260], [78, 150], [70, 95]], [21, 17, 13]),
        ([[128, 240], [125, 110], [124, 45]], [22, 18, 14]),
        ([[163, 240], [170, 115], [174, 55]], [22, 18, 14]),
        ([[196, 250], [214, 150], [224, 102]], [20, 16, 12]),
        ([[190, 345], [255, 275], [285, 225]], [27, 20, 14]),
    )
    for places, radii in fingers:
        line = smooth(np.array(places, dtype=float))
        canvas.stroke(line, np.interp(np.linspace(0, 2, len(line)), [0, 1, 2], radii))
    return canvas


def leaf() -> Canvas:
    """Five lobes, and a stalk."""
    canvas = Canvas(1000, 420)
    angle = np.linspace(-np.pi, np.pi, 900)
    lobes = 0.55 + 0.45 * np.abs(np.cos(2.5 * angle)) ** 1.3 + 0.05 * np.cos(25 * angle)
    radius = 165 * lobes * (0.62 + 0.38 * np.cos(angle / 2) ** 0.6)
    canvas.fill(np.stack([500 + radius * np.sin(angle), 225 - radius * np.cos(angle)], axis=1))
    canvas.stroke(np.array([[500.0, 240.0], [503.0, 320.0], [514.0, 400.0]]), np.array([9.0, 6.0, 5.0]))
    return canvas


def fish() -> Canvas:
    """A body, a tail and fins."""
    canvas = Canvas(1000, 420)
    line = smooth(np.array([[705.0, 215], [770, 200], [850, 208], [930, 222]]))
    along = np.linspace(0, 1, len(line))
    canvas.stroke(line, 12 + 58 * np.sin(np.pi * along**0.75) ** 0.9 * (1 - 0.35 * along))
    for fin in (
        [[905, 222], [950, 160], [985, 120], [968, 222], [985, 318], [950, 280]],
        [[770, 160], [800, 92], [870, 118], [880, 175]],
        [[790, 260], [800, 330], [842, 318], [850, 255]],
    ):
        canvas.fill(smooth(np.array(fin, dtype=float), closed=True))
    return canvas


def silhouettes() -> NDArray[np.uint8]:
    """A hand, a leaf and a fish: labels 1 to 3."""
    labels = np.zeros((420, 1000), dtype=np.uint8)
    for label, canvas in enumerate((hand(), leaf(), fish()), start=1):
        labels[canvas.mask()] = label
    return labels


def colonies() -> NDArray[np.uint8]:
    """Dots in three colonies, one of which lies around another."""
    random = np.random.default_rng(7)
    canvas = Canvas(1000, 420)
    places: list[tuple[float, float]] = []
    while len(places) < 330:
        x, y = float(random.uniform(0, 1000)), float(random.uniform(0, 420))
        from_middle = np.hypot(x - 300, y - 210)
        is_in = from_middle < 55 or 125 < from_middle < 185 or ((x - 760) / 190) ** 2 + ((y - 210) / 120) ** 2 < 1
        if is_in and all((x - u) ** 2 + (y - v) ** 2 > 11**2 for u, v in places):
            places.append((x, y))
            canvas.disc(x, y, 3)
    return canvas.mask().astype(np.uint8) * 255


def strokes() -> NDArray[np.uint8]:
    """Draw a boat on the waves under the sun: a drawing of strokes, as a scanner sees one."""
    canvas = Canvas(1000, 420)
    drawn = (
        ([[250, 270], [300, 330], [420, 345], [560, 340], [650, 318], [700, 262]], 7.0),
        ([[268, 292], [400, 300], [560, 297], [680, 286]], 6.0),
        ([[470, 300], [474, 160], [470, 22]], 6.0),
        ([[486, 40], [560, 110], [610, 190], [632, 262]], 5.0),
        ([[486, 262], [530, 248], [580, 250], [632, 262]], 5.0),
        ([[452, 60], [400, 130], [350, 200], [310, 250]], 5.0),
        ([[310, 250], [360, 236], [410, 240], [456, 252]], 5.0),
        ([[60, 380], [130, 352], [190, 384], [250, 376], [310, 366], [360, 390]], 6.0),
        ([[420, 392], [500, 366], [560, 396], [640, 384], [700, 372], [770, 396]], 6.0),
        ([[760, 350], [820, 328], [870, 356], [930, 340]], 6.0),
    )
    for corners, radius in drawn:
        line = smooth(np.array(corners, dtype=float))
        canvas.stroke(line, np.full(len(line), radius))
    angle = np.linspace(0, 2 * np.pi, 90)
    canvas.stroke(np.stack([840 + 46 * np.cos(angle), 110 + 46 * np.sin(angle)], axis=1), np.full(90, 6.0))
    for turn in np.arange(8) * np.pi / 4 + 0.2:
        way, across = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
        first, last = np.array([840, 110]) + 66 * way, np.array([840, 110]) + 94 * way
        canvas.fill(np.array([first + 5 * across, last + 5 * across, last - 5 * across, first - 5 * across]))
    return canvas.mask().astype(np.uint8) * 255


PICTURES: dict[str, Callable[[], NDArray[np.uint8]]] = {
    "letters": letters,
    "vessels": vessels,
    "river": river,
    "silhouettes": silhouettes,
    "colonies": colonies,
    "strokes": strokes,
}

if __name__ == "__main__":
    Image.fromarray(PICTURES[sys.argv[1]]()).save(sys.stdout.buffer, "PNG")
