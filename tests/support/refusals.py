"""Calls that end with an error."""

import re

import pytest


def refused(kind, words, function, *arguments, **options):
    """Call a function that raises this kind of error; give its message, which has each of the words, or matches it."""
    with pytest.raises(kind) as caught:
        function(*arguments, **options)
    message = str(caught.value)
    for each in [words] if isinstance(words, str) else words:
        assert each in message or re.search(each, message), message
    return message
