"""Logs read by others: every channel with `rosbags` and with the plain `mcap` reader, JSON by its schema."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

from jsonschema import Draft202012Validator
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader


def decoded(path: Path) -> Counter[str]:
    """How many messages of each topic could be decoded.

    Raises:
        AssertionError, jsonschema.ValidationError: one can't be.
    """
    found: Counter[str] = Counter()
    validators: dict[int, Draft202012Validator] = {}
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None
        assert summary.statistics is not None
        for schema, channel, message in reader.iter_messages():
            assert schema is not None
            found[channel.topic] += 1
            if channel.message_encoding == "json":
                if schema.id not in validators:
                    assert schema.encoding == "jsonschema"
                    validators[schema.id] = Draft202012Validator(json.loads(schema.data))
                validators[schema.id].validate(json.loads(message.data))
        counts = summary.statistics.channel_message_counts
        assert {c.topic: counts[i] for i, c in summary.channels.items() if i in counts} == found
    with AnyReader([path]) as bag:
        ros: Counter[str] = Counter()
        for connection, _, raw in bag.messages():
            if connection.ext.serialization_format == "json":
                json.loads(raw)
            else:
                bag.deserialize(raw, connection.msgtype)
            ros[connection.topic] += 1
    assert ros == found
    return found
