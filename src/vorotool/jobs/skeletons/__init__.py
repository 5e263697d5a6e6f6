"""Jobs of skeletons: what `skeleton-exact` and `skeleton-approx` compute, check and write."""
