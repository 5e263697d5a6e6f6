"""Tables of rooms and of what each may use: a line a room, ``room -> other, another``, which may go on indented."""


def arrows_of(table):
    """Give the rooms in their order, each with the set of those that its line names."""
    lines = table.replace("\n    ", " ").strip().splitlines()
    pairs = (line.split(" ->") for line in lines)
    return {room: {name for name in names.replace(" ", "").split(",") if name} for room, names in pairs}
