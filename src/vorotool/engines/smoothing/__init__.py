"""Cubic Bézier curves for lines along skeletons, within a tolerance."""
