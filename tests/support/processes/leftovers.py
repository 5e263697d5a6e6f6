"""What commands leave behind."""


def leftovers(folder):
    """Names of temporary files that should not be there."""
    return [path.name for path in folder.rglob("*") if path.name.startswith(".")]
