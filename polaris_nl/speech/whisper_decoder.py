"""Whisper's decoder, step by step: CTranslate2 runs it, but doesn't let words be weighed on the way.

A transformer that looks at what was said so far and at the encoded sound. (A. Radford et al., "Robust
speech recognition via large-scale weak supervision", ICML 2023; A. Vaswani et al., "Attention is all
you need", NIPS 2017.) Shapes: b readings of t word pieces each, n frames, h heads, d numbers a head, w
numbers in all.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy

Array: TypeAlias = numpy.ndarray[Any, Any]
Memory: TypeAlias = list[tuple[Array, Array]]
"""For each layer the keys and values of what was said so far, (b, h, t, d) each."""
_SMALL = 1e-5
_FAR = -1e9
_DECODER, _SELF, _CROSS, _FFN = "decoder", "self_attention", "attention", "ffn"


class WhisperDecoder:
    """The decoder with its weights, for many sounds.

    Args:
        weights: arrays by their names in CTranslate2's file.
    """

    def __init__(self, weights: Mapping[str, Any]) -> None:
        self._arrays = {
            name: _turned(name, array.astype("float32"))
            for name, array in weights.items()
            if name.startswith(_DECODER) and array.ndim
        }
        self.heads = int(weights[f"{_DECODER}/num_heads"])
        self.layers = [
            layer
            for at in range(len(weights))
            if f"{(layer := f'{_DECODER}/layer_{at}')}/{_SELF}/linear_0/bias" in self._arrays
        ]
        self.pieces = self._arrays[f"{_DECODER}/embeddings/weight"]
        self.places = self._arrays[f"{_DECODER}/position_encodings/encodings"]

    def normal(self, x: Array, name: str) -> Array:
        """Numbers with the mean and the spread that a layer wants; the last axis is theirs."""
        x = x - x.mean(-1, keepdims=True)
        scaled = x / numpy.sqrt((x * x).mean(-1, keepdims=True) + _SMALL)
        return _array(scaled * self._arrays[f"{name}/gamma"] + self._arrays[f"{name}/beta"])

    def linear(self, x: Array, name: str) -> Array:
        """Numbers through a linear layer."""
        return _array(x @ self._arrays[f"{name}/weight"] + self._arrays[f"{name}/bias"])

    def likely(self, x: Array, weights: Array | None = None) -> Array:
        """Logarithms of how likely each word piece is to come next.

        Args:
            x: what the decoder makes of each place, (places, w).
            weights: those of the pieces that count, (pieces, w); None for all.

        Returns:
            (places, pieces).
        """
        scores = x @ (self.pieces if weights is None else weights).T
        scores -= scores.max(-1, keepdims=True)
        scores -= numpy.log(numpy.exp(scores).sum(-1, keepdims=True))
        return _array(scores)

    def listening(self, encoded: Array) -> Listening:
        """The decoder for one sound, (n, w) as the encoder leaves it."""
        return Listening(self, encoded)


class Listening:
    """The decoder with the sound that it listens to.

    Args:
        decoder: the weights.
        encoded: the sound, (n, w).
    """

    def __init__(self, decoder: WhisperDecoder, encoded: Array) -> None:
        self._decoder = decoder
        self.likely = decoder.likely
        self._sound = [self._keys_and_values(layer, encoded) for layer in decoder.layers]

    def following(self, pieces: Array, memory: Memory | None = None) -> tuple[Array, Memory]:
        """How likely each word piece is to come next.

        Args:
            pieces: the numbers of the word pieces that are new, (b, t).
            memory: of what came before them, as it was returned for that.

        Returns:
            What the decoder makes of each place, (b, t, w), for `likely`; and the memory of all so far.
        """
        decoder, kept = self._decoder, list[tuple[Array, Array]]()
        start = memory[0][0].shape[2] if memory else 0
        x = decoder.pieces[pieces] + decoder.places[start : start + pieces.shape[1]]
        for at, layer in enumerate(decoder.layers):
            before = memory[at] if memory else None
            said, both = self._of_words(
                decoder.normal(x, f"{layer}/{_SELF}/layer_norm"), layer, before
            )
            kept.append(both)
            x = x + said
            x = x + self._of_sound(decoder.normal(x, f"{layer}/{_CROSS}/layer_norm"), layer, at)
            inner = decoder.linear(
                decoder.normal(x, f"{layer}/{_FFN}/layer_norm"), f"{layer}/{_FFN}/linear_0"
            )
            x = x + decoder.linear(_gelu(inner), f"{layer}/{_FFN}/linear_1")
        return decoder.normal(x, f"{_DECODER}/layer_norm"), kept

    def _keys_and_values(self, layer: str, encoded: Array) -> tuple[Array, Array]:
        """The sound as a layer looks at it: keys (h, d, n) and values (h, n, d)."""
        both = self._decoder.linear(encoded, f"{layer}/{_CROSS}/linear_1")
        both = both.reshape(len(encoded), 2, self._decoder.heads, -1)
        keys, values = both[:, 0].transpose(1, 2, 0), both[:, 1].transpose(1, 0, 2)
        return numpy.ascontiguousarray(keys), numpy.ascontiguousarray(values)

    def _of_words(
        self, x: Array, layer: str, before: tuple[Array, Array] | None
    ) -> tuple[Array, tuple[Array, Array]]:
        """What the words so far tell of each, and their keys and values."""
        b, t, w = x.shape
        three = self._decoder.linear(x, f"{layer}/{_SELF}/linear_0")
        asked, keys, values = three.reshape(b, t, 3, self._decoder.heads, -1).transpose(
            2, 0, 3, 1, 4
        )
        asked = _scaled(asked)
        if before is not None:
            keys = numpy.concatenate([before[0], keys], 2)
            values = numpy.concatenate([before[1], values], 2)
        scores = asked @ keys.transpose(0, 1, 3, 2)
        all_so_far = keys.shape[2]
        later = numpy.arange(all_so_far) > numpy.arange(all_so_far - t, all_so_far)[:, None]
        found = _attended(numpy.where(later, _FAR, scores).astype("float32"), values)
        found = found.transpose(0, 2, 1, 3).reshape(b, t, w)
        return self._decoder.linear(found, f"{layer}/{_SELF}/linear_1"), (keys, values)

    def _of_sound(self, x: Array, layer: str, at: int) -> Array:
        """What the sound tells of each word; all readings share it."""
        b, t, w = x.shape
        keys, values = self._sound[at]
        asked = self._decoder.linear(x, f"{layer}/{_CROSS}/linear_0")
        asked = _scaled(asked.reshape(b * t, self._decoder.heads, -1).transpose(1, 0, 2))
        found = _attended(asked @ keys, values).transpose(1, 0, 2).reshape(b, t, w)
        return self._decoder.linear(found, f"{layer}/{_CROSS}/linear_2")


def _turned(name: str, array: Array) -> Array:
    """Linear layers as they are multiplied from the right."""
    return array.T if "/linear_" in name and array.ndim == 2 else array


def _scaled(asked: Array) -> Array:
    """What is asked, so that its products with the keys don't grow with their size."""
    return _array(asked / numpy.sqrt(asked.shape[-1]))


def _attended(scores: Array, values: Array) -> Array:
    """Values in the shares that scores give them."""
    scores = scores - scores.max(-1, keepdims=True)
    shares = numpy.exp(scores, out=scores)
    return _array((shares @ values) / shares.sum(-1, keepdims=True))


def _gelu(x: Array) -> Array:
    """The activation of its layers, by its usual approximation."""
    return _array(0.5 * x * (1 + numpy.tanh(0.7978845608 * (x + 0.044715 * x * x * x))))


def _array(x: Any) -> Array:
    """An array of single precision."""
    return numpy.asarray(x, dtype="float32")


def forced(
    listening: Listening, prompt: Sequence[int], texts: Sequence[Sequence[int]], ends: Sequence[int]
) -> list[float]:
    """The natural logarithm of the likelihood of word pieces and no more, given the sound.

    Args:
        listening: the decoder with the sound.
        prompt: the pieces that every text begins with.
        texts: the pieces of each text.
        ends: pieces that may stand behind the last word: without one of them, half of what was said
            would be likelier than the whole.
    """
    size = max(map(len, texts), default=0)
    rows = numpy.array([[*prompt, *text, *[ends[0]] * (size - len(text))] for text in texts])
    if not len(rows):
        return []
    found, _ = listening.following(rows)
    # Many texts begin alike, and what comes next takes most of the time: so each beginning counts once.
    places = {
        tuple(text[:at]): (row, len(prompt) - 1 + at)
        for row, text in enumerate(texts)
        for at in range(len(text) + 1)
    }
    scores = listening.likely(numpy.array([found[place] for place in places.values()]))
    likely = dict(zip(places, scores, strict=True))
    return [
        float(
            sum(likely[tuple(text[:at])][piece] for at, piece in enumerate(text))
            + numpy.logaddexp.reduce(likely[tuple(text)][[*ends]])
        )
        for text in texts
    ]
