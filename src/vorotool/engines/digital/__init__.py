"""Label image -> digital triangulation; comparison with the exact one."""
