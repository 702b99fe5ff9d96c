"""Things of which a part is known already, and the rest is made when somebody asks for it.

Such a thing is of the same class as what it stands for: who asks only for what is known never learns the
difference.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields
from functools import cache, cached_property
from typing import Any, TypeVar

T = TypeVar("T")


def partly(kind: type[T], known: Mapping[str, Any], whole: Callable[[], T]) -> T:
    """A frozen dataclass of which only some attributes are known.

    Parameters
    ----------
    known : mapping of str to anything
        Fields, and what it caches of them.
    whole : callable
        Returns what it stands for; called once, with the first field that is not known.

    Examples
    --------
    >>> from dataclasses import make_dataclass
    >>> Circle = make_dataclass("Circle", ["radius", "area"], frozen=True)
    >>> circle = partly(Circle, {"radius": 2}, lambda: Circle(2, print("now") or 12.566))
    >>> isinstance(circle, Circle), circle.radius, is_partly(circle)
    (True, 2, True)
    >>> circle.area
    now
    12.566
    """
    made: T = object.__new__(_partly(kind))  # type: ignore[arg-type] # a class has its hash
    vars(made).update(known, _make=whole)
    return made


def is_partly(thing: Any) -> bool:
    """Whether a thing was made by :func:`partly`."""
    return "_make" in vars(thing)


def known(thing: Any, name: str) -> Any:
    """What is known of a thing besides its fields; None if nothing is."""
    return vars(thing).get(name)


@cache
def _partly(kind: Any) -> Any:
    """A class whose fields are taken from the whole unless they are known."""

    def whole(self: Any) -> Any:
        return vars(self)["_make"]()

    def equal(self: Any, other: Any) -> Any:
        if self is other:
            return True
        if not isinstance(other, kind) or any(vars(self).get(n, own) != own for n, own in known_of(other)):
            return False
        return self._whole == (other._whole if is_partly(other) else other)

    def known_of(other: Any) -> Iterator[tuple[str, Any]]:
        return ((name, vars(other)[name]) for name in names if name in vars(other))

    def part(name: str) -> cached_property[Any]:
        found = cached_property(lambda self: getattr(self._whole, name))
        found.__set_name__(kind, name)
        return found

    names = [field.name for field in fields(kind)]
    own: dict[str, Any] = {name: part(name) for name in names}
    own["_whole"] = cached_property(whole)
    own["_whole"].__set_name__(kind, "_whole")
    own |= {"__eq__": equal, "__hash__": lambda self: hash(self._whole), "__module__": kind.__module__}
    own["__new__"] = lambda _, *fields, **named: kind(*fields, **named)  # what `replace` makes is whole
    return type(kind.__name__, (kind,), own)
