"""Jobs of volumes: what `tessellate` reads and writes in three dimensions."""
