"""Checks of approximate skeletons: their samples, and their arrays."""

from vorotool.engines.sampled_skeleton.verify_approximate import verify_samples
from vorotool.engines.skeleton.verify_skeleton import verify_skeleton


def verify_approximate(found, *, step=None):
    """Check an approximate skeleton from its samples and arrays."""
    verify_samples(found, step=step)
    verify_skeleton(found.skeleton)
