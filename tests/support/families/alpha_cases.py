"""What tests of alpha complexes and alpha shapes begin with."""

import warnings

from vorotool import VorotoolWarning, alpha_complex


def quietly(points, **options):
    """The family; duplicates are expected."""
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        return alpha_complex(points, **options)
