"""Cuts of Voronoi diagrams: frames with clips, and enclosures that share themselves out each alone."""
