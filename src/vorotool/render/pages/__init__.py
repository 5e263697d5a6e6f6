"""HTML and plotted pages."""
