"""GeoJSON, WKT, format names and reader options: what readers share."""
