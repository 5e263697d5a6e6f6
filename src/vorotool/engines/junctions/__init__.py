"""Junctions of skeletons that are nearer to each other than the boundary is: made one, and the check of that."""
