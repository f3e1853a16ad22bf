"""Arguments of public functions, checked against their own annotations, in this one place.

A function says in its signature what it takes; `checked` holds callers to it. What a signature
cannot say (a range, a shape, a name that must exist) the function asks of `validation`.
"""

from __future__ import annotations

import functools
import inspect
import os
import sys
import types
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final, TypeVar, Union, cast, get_args, get_origin

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.validation import is_real, plain_number, real_array, shown, whole_number

F = TypeVar("F", bound=Callable[..., Any])
Check = Callable[[str, Any], Any]
"""Takes the argument's name and value, returns the value to use, or raises `InputError`."""

_LONGEST_NAME: Final = 255
"""Characters in the name of a file on every file system in use."""


def checked(function: F) -> F:
    """Refuse arguments that are not what the annotations of a function or class ask for.

    Numbers in NumPy's boxes (scalars, arrays without dimensions) are taken out of them. Parameters
    annotated `Any`, and defaults, are left alone. Of a class, a dataclass too, ``__init__`` is
    held to its annotations.

    Raises
    ------
    InputError
        When called with such an argument; one line that names it, what it must be and what it is.
    """
    if isinstance(function, type):
        kind: Any = function
        kind.__init__ = checked(kind.__init__)
        return cast(F, kind)
    parameters = inspect.signature(function).parameters.values()
    order = [p.name for p in parameters if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)]

    @functools.cache  # on the first call, when every name in an annotation is defined
    def checks() -> dict[str, Check]:
        named = [p for p in parameters if p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD)]
        found = {p.name: _check_for(_resolved(function, p.annotation)) for p in named}
        return {name: check for name, check in found.items() if check is not None}

    @functools.wraps(function)
    def call(*args: Any, **named: Any) -> Any:
        known = checks()
        given = list(args)  # too many or too few are left for Python to name
        for place, (name, value) in enumerate(zip(order, args, strict=False)):
            if name in known:
                given[place] = known[name](name, value)
        for name, value in named.items():
            if name in known:
                named[name] = known[name](name, value)
        return function(*given, **named)

    call.__checked__ = True  # type: ignore[attr-defined]
    return cast(F, call)


def file_path(name: str, value: Any) -> Path:
    """Return ``value`` as a path that a file system can hold, or raise `InputError`."""
    if not isinstance(value, (str, os.PathLike)):
        raise InputError(f"{name} must be a path, not {shown(value)}")
    try:
        text = os.fspath(value)
    except Exception:  # an object that promises a path and has none
        raise InputError(f"{name} must be a path, not {shown(value)}") from None
    if not isinstance(text, str):
        raise InputError(f"{name} must be a path of text, not {shown(value)}")
    if not text or "\0" in text:
        raise InputError(f"{name} = {shown(text)} is not a path: give the name of a file or folder")
    try:
        os.fsencode(text)
        longest = max(len(os.fsencode(part)) for part in Path(text).parts)
    except (UnicodeEncodeError, ValueError):
        raise InputError(f"{name} = {shown(text)} cannot be the name of a file") from None
    if longest > _LONGEST_NAME:
        raise InputError(
            f"{name} = {shown(text)} is too long: a file's name has up to {_LONGEST_NAME} bytes, "
            f"this one {longest}"
        )
    try:
        return Path(text).expanduser()
    except RuntimeError:
        raise InputError(f"{name} = {shown(text)}: there is no such home folder") from None


def _resolved(function: Any, annotation: Any) -> Any:
    if annotation is inspect.Parameter.empty:
        return Any
    if not isinstance(annotation, str):
        return annotation
    module = sys.modules[function.__module__]
    return eval(annotation, {**vars(module), **getattr(function, "__globals__", {})})


def _check_for(annotation: Any) -> Check | None:
    """Return what holds an argument to its annotation; None if that allows anything."""
    if annotation in _SIMPLE:
        return _SIMPLE[annotation]
    if getattr(annotation, "_is_protocol", False) and not annotation._is_runtime_protocol:
        return None  # the function asks for what it needs
    origin, inside = get_origin(annotation), get_args(annotation)
    if origin in (Union, types.UnionType):
        return _check_for_union(inside)
    if origin is tuple:
        return _numbers(inside)
    if origin is not None and isinstance(origin, type):
        if issubclass(origin, Mapping):
            return _instance_of(Mapping)
        if issubclass(origin, Sequence) or issubclass(origin, Iterable):
            return _sequence_of(inside[0])
        return _instance_of(origin)
    return _instance_of(annotation) if isinstance(annotation, type) else None


def _check_for_union(kinds: tuple[Any, ...]) -> Check | None:
    others = [kind for kind in kinds if kind is not types.NoneType]
    if str in others and any(kind is Path or get_origin(kind) is os.PathLike for kind in others):
        others = [kind for kind in others if kind is not Path and get_origin(kind) is None]
        checks = [file_path_as_given if kind is str else _check_for(kind) for kind in others]
    else:
        checks = [_check_for(kind) for kind in others]
    if None in checks:
        return None
    check = _any_of(cast(list[Check], checks))
    if types.NoneType not in kinds:
        return check
    return lambda name, value: None if value is None else check(name, value)


def _any_of(checks: list[Check]) -> Check:
    def check(name: str, value: Any) -> Any:
        wanted = []
        for one in checks:
            try:
                return one(name, value)
            except InputError as error:
                kind = str(error).partition(f"{name} must be ")[2].partition(", not ")[0]
                if not kind:  # the right kind, with something else wrong
                    raise
                wanted.append(kind)
        raise InputError(f"{name} must be {' or '.join(wanted)}, not {shown(value)}")

    return check if len(checks) > 1 else checks[0]


def file_path_as_given(name: str, value: Any) -> Any:
    """Return ``value`` itself if it is a path, with ``~`` spelt out, or raise `InputError`."""
    path = file_path(name, value)
    return path if os.fspath(value).startswith("~") else value


def _flag(name: str, value: Any) -> bool:
    value = plain_number(value)
    if not isinstance(value, bool):
        raise InputError(f"{name} must be True or False, not {shown(value)}")
    return value


def _number(name: str, value: Any) -> float:
    value = plain_number(value)
    if not is_real(value):
        raise InputError(f"{name} must be a number, not {shown(value)}")
    if value != value:
        raise InputError(f"{name} = nan is out of range: it must be a number")
    return cast(float, value)


def _complex(name: str, value: Any) -> complex:
    value = plain_number(value)
    if not is_real(value) and not isinstance(value, (complex, np.complexfloating)):
        raise InputError(f"{name} must be a number, not {shown(value)}")
    try:
        number = complex(value)
    except OverflowError:
        number = complex(np.nan)
    if not np.isfinite(number):
        raise InputError(f"{name} must be a finite number, not {shown(value)}")
    return number


def _whole(name: str, value: Any) -> int:
    value = plain_number(value)
    if not is_real(value):
        raise InputError(f"{name} must be a whole number, not {shown(value)}")
    if value != value or value in (np.inf, -np.inf) or value != int(value):
        raise InputError(f"{name} = {shown(value)} is out of range: it must be a whole number")
    return int(value)


def _text(name: str, value: Any) -> str:
    if not isinstance(value, str):
        raise InputError(f"{name} must be text, not {shown(value)}")
    return str(value)


def _instance_of(kind: type) -> Check:
    package, word = kind.__module__.partition(".")[0], kind.__name__
    if kind is Mapping:
        word = "a table of names and values"
    elif package != __name__.partition(".")[0]:
        word = f"{package}'s {word}"
    elif not word.endswith("s"):
        word = f"{'an' if word[0] in 'AEIOU' else 'a'} {word}"

    def check(name: str, value: Any) -> Any:
        if not isinstance(value, kind):
            raise InputError(f"{name} must be {word}, not {shown(value)}")
        return value

    return check


def _sequence_of(kind: Any) -> Check:
    inner = _check_for(kind)

    def check(name: str, value: Any) -> Any:
        if isinstance(kind, type) and isinstance(value, kind):
            value = [value]  # one is a list of one
        elif isinstance(value, np.ndarray) and value.dtype == object:
            value = value.ravel()  # axes as plt.subplots gives them
        try:
            if isinstance(value, (str, bytes, Mapping)):
                raise TypeError
            items = list(value)
        except Exception:
            raise InputError(f"{name} must be a list, not {shown(value)}") from None
        if inner is None:
            return value if isinstance(value, Sequence) else items
        return [inner(f"{name}[{place}]", item) for place, item in enumerate(items)]

    return check


def _numbers(kinds: tuple[Any, ...]) -> Check:
    """Hold a tuple of numbers to its length."""
    count = {2: "two", 3: "three"}.get(len(kinds), str(len(kinds)))
    wanted = f"{count} {'whole ' if set(kinds) == {int} else ''}numbers"

    def check(name: str, value: Any) -> Any:
        try:
            numbers = real_array(name, value, (len(kinds),)).tolist()
        except InputError:
            raise InputError(f"{name} must be {wanted}, not {shown(value)}") from None
        return tuple(
            whole_number(name, number, -(2**53)) if kind is int else number
            for kind, number in zip(kinds, numbers, strict=True)
        )

    return check


_SIMPLE: Final[dict[Any, Check | None]] = {
    Any: None,
    object: None,
    np.ndarray: None,  # the function asks for its shape
    bool: _flag,
    float: _number,
    complex: _complex,
    int: _whole,
    str: _text,
    Path: file_path,
}
