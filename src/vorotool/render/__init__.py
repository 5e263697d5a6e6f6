"""Pictures of results: SVG, PNG, palettes."""
