"""Data classes that compile nothing, beside those of the standard library."""

import pickle
from dataclasses import FrozenInstanceError, asdict, dataclass, field, fields, is_dataclass, replace
from inspect import signature

import pytest

from vorotool.frozen import frozen


def definitions(decorate, decorate_by_identity):
    """The same classes made by two decorators."""

    @decorate
    class Place:
        """A place."""

        x: float
        y: float = 2.0
        names: list[str] = field(default_factory=list, compare=False)

    @decorate
    class Named(Place):
        """With a name."""

        name: str = field(default="a", kw_only=True)

        def __post_init__(self):
            object.__setattr__(self, "x", float(self.x))

    @decorate_by_identity
    class Alone:
        """Equal to itself alone."""

        x: int

        def __repr__(self):
            return "alone"

    return Place, Named, Alone


OURS = definitions(frozen, frozen(eq=False))
THEIRS = definitions(dataclass(frozen=True), dataclass(frozen=True, eq=False))

GIVEN = [
    *(((1,), {}), ((1, 3), {}), ((1, 3, ["b"]), {}), ((), {"x": 1}), ((1,), {"y": 5, "names": []})),
    *(((), {}), ((1, 2, [], 4), {}), ((1,), {"x": 2}), ((1,), {"z": 2}), ((1,), {"name": "n"})),
]


def outcome(kind, given, named):
    try:
        made = kind(*given, **named)
    except TypeError as error:
        return type(error)
    return repr(made).rpartition("<locals>.")[2], made == kind(*given, **named), asdict(made)


@pytest.mark.parametrize("which", [0, 1])
@pytest.mark.parametrize(("given", "named"), GIVEN)
def test_made_as_those_of_the_library(which, given, named):
    assert outcome(OURS[which], given, named) == outcome(THEIRS[which], given, named)


@pytest.mark.parametrize("which", [0, 1, 2])
def test_they_look_the_same(which):
    ours, theirs = OURS[which], THEIRS[which]
    assert str(signature(ours)) == str(signature(theirs))
    assert [each.name for each in fields(ours)] == [each.name for each in fields(theirs)]
    assert is_dataclass(ours)
    assert ours.__match_args__ == theirs.__match_args__


def test_values_do_not_change():
    place = OURS[0](1.0)
    for change in (lambda: setattr(place, "x", 2), lambda: setattr(place, "other", 2), lambda: delattr(place, "x")):
        with pytest.raises(FrozenInstanceError):
            change()
    assert replace(place, y=7.0).y == 7.0
    assert place.names is not OURS[0](1.0).names


def test_equal_values_have_one_hash():
    one, same, other = OURS[0](1.0), OURS[0](1.0, names=["not compared"]), OURS[0](2.0)
    with pytest.raises(AssertionError):
        assert one == other
    assert one == same
    plain_place = frozen(type("Pair", (), {"__doc__": "Two.", "__annotations__": {"a": "int", "b": "int"}}))
    assert hash(plain_place(1, 2)) == hash(plain_place(1, 2))
    assert one != OURS[1](1.0)
    alone = OURS[2](1)
    assert alone != OURS[2](1)
    assert len({alone, OURS[2](1)}) == 2
    assert repr(alone) == "alone"


@frozen
class Kept:
    """What pickle finds by its name."""

    a: int
    b: str = "b"


def test_processes_hand_them_on():
    assert pickle.loads(pickle.dumps(Kept(1))) == Kept(1)
