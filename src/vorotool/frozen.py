"""Frozen data classes that compile nothing when their module is imported.

`dataclasses.dataclass` writes methods as text and compiles them, for each class: a fifth of the time of a short job.
What `frozen` makes has the same fields, so that `replace`, `fields` and `asdict` take it; one function stands for the
methods of all.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, FrozenInstanceError, dataclass, field, fields
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn, TypeVar, dataclass_transform, overload

if TYPE_CHECKING:
    from inspect import Signature

T = TypeVar("T")


@overload
def frozen(kind: type[T], /) -> type[T]: ...


@overload
def frozen(*, eq: bool = True, repr: bool = True) -> Callable[[type[T]], type[T]]: ...


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
def frozen(kind: type[Any] | None = None, /, *, eq: bool = True, repr: bool = True) -> Any:
    """Make a frozen data class; without `eq` each value equals itself alone, without `repr` it is shown as by its base.

    Examples
    --------
    >>> @frozen
    ... class Size:
    ...     "Of a page."
    ...
    ...     width: int
    ...     height: int = 3
    >>> Size(4), Size(4, height=3) == Size(4)
    (Size(width=4, height=3), True)
    """
    if kind is None:
        return partial(frozen, eq=eq, repr=repr)
    own = {name: vars(kind).get(name) for name in ("__init__", "__repr__", "__eq__", "__hash__")}
    made: Any = dataclass(init=False, repr=False, eq=False)(kind)
    made.__init__, made.__setattr__, made.__delattr__ = own["__init__"] or _init, _refuse, _refuse
    if repr and own["__repr__"] is None:
        made.__repr__ = _repr
    if eq and own["__eq__"] is None:
        made.__eq__, made.__hash__ = _eq, own["__hash__"] or _hash
    if own["__init__"] is None:
        made.__signature__ = _Signature()
    return made


class _Plan(NamedTuple):
    """What making a value of a class looks up."""

    by_place: list[str]
    by_name: frozenset[str]
    usual: dict[str, Any]  # of all fields, in their order; what has no default is MISSING
    required: frozenset[str]
    factories: list[tuple[str, Callable[[], Any]]]
    settle: Callable[[Any], None] | None


_PLANS: dict[type[Any], _Plan] = {}


def _plan_of(kind: type[Any]) -> _Plan:
    """Return the plan of a class, which is made with its first value."""
    if kind not in _PLANS:
        own = fields(kind)
        _PLANS[kind] = _Plan(
            [each.name for each in own if each.init and not each.kw_only],
            frozenset(each.name for each in own if each.init),
            {each.name: each.default for each in own},
            frozenset(each.name for each in own if each.default is MISSING and each.default_factory is MISSING),
            [(each.name, each.default_factory) for each in own if each.default_factory is not MISSING],
            getattr(kind, "__post_init__", None),
        )
    return _PLANS[kind]


def _init(self: Any, /, *given: Any, **named: Any) -> None:
    kind = type(self)
    plan = _PLANS.get(kind) or _plan_of(kind)
    fresh = dict(zip(plan.by_place, given, strict=False))
    fresh.update(named)
    if len(fresh) != len(given) + len(named) or not plan.required <= fresh.keys() <= plan.by_name:
        _refuse_arguments(kind, given, named)
    held = self.__dict__
    held.update(plan.usual)
    held.update(fresh)
    for name, factory in plan.factories:
        if name not in fresh:
            held[name] = factory()
    if plan.settle is not None:
        plan.settle(self)


def _refuse_arguments(kind: type[Any], given: tuple[Any, ...], named: dict[str, Any]) -> NoReturn:
    plan = _plan_of(kind)
    if len(given) > len(plan.by_place):
        raise TypeError(f"{kind.__name__}() takes {len(plan.by_place)} values by place, but got {len(given)}")
    placed = plan.by_place[: len(given)]
    for said, names in (
        ("got multiple values for", named.keys() & placed),
        ("got an unexpected keyword", named.keys() - plan.by_name),
        ("missing required", plan.required - named.keys() - set(placed)),
    ):
        if names:
            raise TypeError(f"{kind.__name__}() {said} argument {min(names)!r}")
    raise AssertionError


def unchecked(kind: type[T], /, **named: Any) -> T:
    """Make a value of fields that are known to fit: what has no default has to be among them."""
    made, plan = object.__new__(kind), _plan_of(kind)
    made.__dict__.update(plan.usual)
    made.__dict__.update((name, factory()) for name, factory in plan.factories if name not in named)
    made.__dict__.update(named)
    return made


def _refuse(self: Any, name: str, *_: Any) -> NoReturn:
    raise FrozenInstanceError(f"cannot assign to field {name!r}")


def _repr(self: Any) -> str:
    shown = (f"{each.name}={getattr(self, each.name)!r}" for each in fields(self) if each.repr)
    return f"{type(self).__qualname__.rpartition('<locals>.')[2]}({', '.join(shown)})"


def _compared(self: Any) -> tuple[Any, ...]:
    return tuple(getattr(self, each.name) for each in fields(self) if each.compare)


def _eq(self: Any, other: object) -> Any:
    return _compared(self) == _compared(other) if type(self) is type(other) else NotImplemented


def _hash(self: Any) -> int:
    return hash(_compared(self))


class _Factory:
    """The default of what each value has one of its own of."""

    def __repr__(self) -> str:
        return "<factory>"


_FACTORY = _Factory()


class _Signature:
    """The signature of a class, which is made when somebody looks."""

    def __get__(self, _: object, kind: type[Any]) -> Signature:
        from inspect import Parameter, Signature

        made = []
        for each in sorted(fields(kind), key=lambda each: bool(each.kw_only)):
            usual = each.default if each.default is not MISSING else Parameter.empty
            if each.default_factory is not MISSING:
                usual = _FACTORY
            place = Parameter.KEYWORD_ONLY if each.kw_only else Parameter.POSITIONAL_OR_KEYWORD
            made.append(Parameter(each.name, place, default=usual, annotation=each.type))
        return Signature(made, return_annotation=None)
