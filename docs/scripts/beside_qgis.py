"""Draw the scenes of `docs/scripts/beside.py` with QGIS: `python3 docs/scripts/beside_qgis.py FOLDER`.

The Python is one that has the modules of QGIS.

What is drawn lies in the folder: `NAME.png` with a world file, if there is an image, `NAME-*.geojson`, and `size.txt`.
"""

import sys
from pathlib import Path

from qgis.core import (
    QgsApplication,
    QgsFillSymbol,
    QgsLineSymbol,
    QgsMapRendererParallelJob,
    QgsMapSettings,
    QgsMarkerSymbol,
    QgsRasterLayer,
    QgsRectangle,
    QgsVectorLayer,
    QgsWkbTypes,
)
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QColor

SYMBOLS = {
    QgsWkbTypes.PolygonGeometry: lambda: QgsFillSymbol.createSimple({"color": "#e4e4e4", "outline_color": "#909090"}),
    QgsWkbTypes.LineGeometry: lambda: QgsLineSymbol.createSimple({"color": "#b2182b", "width": "0.5"}),
    QgsWkbTypes.PointGeometry: lambda: QgsMarkerSymbol.createSimple({"color": "#332288", "size": "1.4"}),
}


def drawn(folder: Path, name: str, size: tuple[int, int], bounds: tuple[float, ...]) -> None:
    """Draw one scene as `NAME-qgis.png`."""
    layers = []
    for path in sorted(folder.glob(f"{name}-*.geojson")):
        layer = QgsVectorLayer(str(path), path.stem, "ogr")
        assert layer.isValid(), path
        layer.renderer().setSymbol(SYMBOLS[layer.geometryType()]())
        layers.append(layer)
    if (image := folder / f"{name}.png").exists():
        layers.append(QgsRasterLayer(str(image), name))
    settings = QgsMapSettings()
    settings.setLayers(layers)
    settings.setBackgroundColor(QColor("white"))
    settings.setOutputSize(QSize(*size))
    settings.setExtent(QgsRectangle(*bounds))
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    job.renderedImage().save(str(folder / f"{name}-qgis.png"))


def main() -> None:
    """Draw all of them."""
    QgsApplication.setPrefixPath("/usr", True)
    program = QgsApplication([], False)
    program.initQgis()
    folder = Path(sys.argv[1])
    for line in (folder / "size.txt").read_text().splitlines():
        name, *numbers = line.split()
        values = [float(number) for number in numbers]
        drawn(folder, name, (int(values[0]), int(values[1])), tuple(values[2:]))
    program.exitQgis()


if __name__ == "__main__":
    main()
