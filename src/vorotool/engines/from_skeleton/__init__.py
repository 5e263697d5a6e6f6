"""Nearest points, points along branches, reconstruction, contours."""
