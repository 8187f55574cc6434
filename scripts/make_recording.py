"""Makes the recordings of the demo with a synthetic voice.

Needs the package hibari-tts (Apache-2.0), which is no dependency of the project: the recordings are kept in the
repository, and this says how they came about. Run it as: python scripts/make_recording.py
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy
import soundfile
import soxr

RATE = 16_000
PAUSE_S = 0.9
EDGE_S = 0.5

RECORDINGS = {
    "lunch": (
        "Tell the resident that lunch is ready.",
        "Once she acknowledges, bring a full tray to her table and then go home.",
        "If she dismisses it, just go home.",
    ),
    "lunch-in-one-breath": (
        "Tell the resident that lunch is ready, once she acknowledges bring a full tray to her table, then go "
        "home, if she dismisses it just go home.",
    ),
}


def main() -> None:
    """Speaks and writes every recording."""
    from hibari import SAMPLE_RATE, Hibari

    folder = Path(__file__).parent.parent / "domains" / "caregiving" / "recordings"
    folder.mkdir(exist_ok=True)
    voice = Hibari()
    for name, sentences in RECORDINGS.items():
        parts = [numpy.zeros(int(EDGE_S * RATE), dtype="float32")]
        for sentence in sentences:
            spoken = soxr.resample(voice(sentence), SAMPLE_RATE, RATE)
            parts += [spoken, numpy.zeros(int(PAUSE_S * RATE), dtype="float32")]
        audio = numpy.concatenate(parts)
        audio = audio / max(float(numpy.abs(audio).max()), 1e-6) * 0.8
        path = folder / f"{name}.flac"
        soundfile.write(path, audio, RATE, format="FLAC", subtype="PCM_16")
        sys.stdout.write(f"{path.name}: {len(audio) / RATE:.1f} s, {path.stat().st_size:,} bytes\n")


if __name__ == "__main__":
    main()
