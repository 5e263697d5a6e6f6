"""What readers share: GeoJSON, reference systems, names of formats, options."""
