"""JSON Schemas of the event records, from their annotations, and events as JSON values."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from types import NoneType, UnionType
from typing import Any, get_args, get_origin, get_type_hints

from polaris_nl.execution.events import EVENTS, Event, Stepped

_ALL: tuple[type[Event], ...] = (*EVENTS, Stepped)
BY_TOPIC: Mapping[str, type[Event]] = {event.topic: event for event in _ALL}
_NAMES: Mapping[type[Event], tuple[str, ...]] = {
    kind: tuple(f.name for f in dataclasses.fields(kind)) for kind in BY_TOPIC.values()
}
_PLAIN: Mapping[Any, dict[str, Any]] = {
    str: {"type": "string"},
    int: {"type": "integer"},
    float: {"type": "number"},
    bool: {"type": "boolean"},
    NoneType: {"type": "null"},
    Any: {},
}


def schema_of(event: type[Event]) -> dict[str, Any]:
    """The JSON Schema of an event class."""
    hints = get_type_hints(event)
    fields = dataclasses.fields(event)
    required = [
        f.name
        for f in fields
        if f.default is dataclasses.MISSING and f.default_factory is dataclasses.MISSING
    ]
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": f"polaris.{event.__name__}",
        "description": (event.__doc__ or "").strip().splitlines()[0],
        "type": "object",
        "properties": {f.name: _type(hints[f.name]) for f in fields},
        "required": required,
        "additionalProperties": False,
    }


def event_json(event: Event) -> dict[str, Any]:
    """An event as a JSON value."""
    return {name: getattr(event, name) for name in names_of(type(event))}


def names_of(kind: type[Event]) -> tuple[str, ...]:
    """The names of an event class's fields."""
    return _NAMES[kind]


def event_of(topic: str, value: Mapping[str, Any]) -> Event | None:
    """The event of a topic's JSON value; None for a topic that isn't known.

    Fields that this version doesn't know are left out, so that newer logs can be read.
    """
    kind = BY_TOPIC.get(topic)
    if kind is None:
        return None
    known = names_of(kind)
    try:
        return kind(**{k: v for k, v in value.items() if k in known})
    except TypeError:
        return None


def _type(hint: Any) -> dict[str, Any]:
    if hint in _PLAIN:
        return dict(_PLAIN[hint])
    origin, args = get_origin(hint), get_args(hint)
    if origin is UnionType:
        return {"anyOf": [_type(x) for x in args]}
    if origin is list:
        return {"type": "array", "items": _type(args[0])}
    return {"type": "object"}
