"""Functions by the names that users of SciPy, scikit-image and shapely know, over the engines of this package."""
