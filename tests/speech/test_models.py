"""Finding, checking and fetching the speech model, with archives made here."""

from __future__ import annotations

import hashlib
import zipfile
from pathlib import Path

import pytest

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech import models


def make_model(folder: Path) -> Path:
    for name in models._NEEDED:
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(b"--beam=10.0\n--other=1\n")
    return folder


@pytest.fixture
def no_override(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.delenv(models.OVERRIDE)
    monkeypatch.setenv("HOME", str(tmp_path))
    return tmp_path


def test_a_missing_model_is_one_sentence_with_the_command(no_override: Path) -> None:
    with pytest.raises(SpeechError, match=r"model is missing\. Fetch it with: polaris-nl models"):
        models.model_folder()


def test_a_damaged_model_names_the_file_and_the_command(no_override: Path) -> None:
    folder = make_model(models.usual_folder())
    (folder / "am/final.mdl").write_bytes(b"")
    with pytest.raises(SpeechError, match=r"am/final\.mdl is cut off\. Fetch it with"):
        models.model_folder()
    (folder / "am/final.mdl").unlink()
    with pytest.raises(SpeechError, match=r"am/final\.mdl is missing"):
        models.model_folder()


def test_a_cut_off_file_of_the_usual_model_is_noticed_by_its_size(no_override: Path) -> None:
    make_model(models.usual_folder())
    with pytest.raises(SpeechError, match="is cut off"):
        models.model_folder()


def test_another_folder_can_be_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    folder = make_model(tmp_path / "mine")
    monkeypatch.setenv(models.OVERRIDE, str(folder))
    assert models.model_folder() == folder
    monkeypatch.setenv(models.OVERRIDE, str(tmp_path / "nowhere"))
    with pytest.raises(SpeechError, match="nowhere, which is no folder"):
        models.model_folder()


def packed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, content: bytes = b"x") -> None:
    archive = tmp_path / "source.zip"
    with zipfile.ZipFile(archive, "w") as file:
        for name in models._NEEDED:
            file.writestr(models.INSIDE + name, content)
        file.writestr("something/else", b"no")
    monkeypatch.setattr(models, "_SIZES", {})
    monkeypatch.setattr(models, "SHA256", hashlib.sha256(archive.read_bytes()).hexdigest())

    def download(target: Path, progress: models.Progress) -> None:
        target.write_bytes(archive.read_bytes())
        progress(1, 1)

    monkeypatch.setattr(models, "_download", download)


def test_fetching_unpacks_the_model_and_leaves_nothing_else(
    monkeypatch: pytest.MonkeyPatch, no_override: Path
) -> None:
    packed(monkeypatch, no_override)
    told: list[tuple[int, int]] = []
    folder = models.fetch(lambda done, total: told.append((done, total)))
    assert folder == models.usual_folder() == models.model_folder()
    assert told == [(1, 1)]
    assert [p.name for p in folder.parent.iterdir()] == [folder.name]
    assert {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()} == set(
        models._NEEDED
    )


def test_a_wrong_checksum_keeps_nothing(monkeypatch: pytest.MonkeyPatch, no_override: Path) -> None:
    packed(monkeypatch, no_override)
    monkeypatch.setattr(models, "SHA256", "0" * 64)
    with pytest.raises(SpeechError, match="checksum is wrong"):
        models.fetch()
    assert list(models.usual_folder().parent.iterdir()) == []


def test_a_damaged_model_is_replaced_and_a_whole_one_kept(
    monkeypatch: pytest.MonkeyPatch, no_override: Path
) -> None:
    packed(monkeypatch, no_override, b"new")
    folder = models.usual_folder()
    make_model(folder)
    (folder / "ivector/final.ie").unlink()
    models.fetch()
    assert (folder / "ivector/final.ie").read_bytes() == b"new"
    packed(monkeypatch, no_override, b"newer")
    models.fetch()
    assert (folder / "ivector/final.ie").read_bytes() == b"new"


def test_no_connection_says_so(monkeypatch: pytest.MonkeyPatch, no_override: Path) -> None:
    monkeypatch.setenv("HTTPS_PROXY", "http://127.0.0.1:9")
    monkeypatch.setenv("https_proxy", "http://127.0.0.1:9")
    monkeypatch.delenv("NO_PROXY", raising=False)
    monkeypatch.delenv("no_proxy", raising=False)
    with pytest.raises(SpeechError, match=r"no connection to its publisher.*POLARIS_NL_MODEL"):
        models.fetch()
    assert list(models.usual_folder().parent.iterdir()) == []


def test_no_room_says_so(monkeypatch: pytest.MonkeyPatch, no_override: Path) -> None:
    def full(target: Path, progress: models.Progress) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(models, "_download", full)
    with pytest.raises(SpeechError, match="No space left on device"):
        models.fetch()


def test_the_tuned_copy_links_and_searches_more_widely(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    folder = make_model(tmp_path / "mine")
    copy = models.tuned(folder)
    assert copy != folder
    assert (copy / "am/final.mdl").is_symlink()
    lines = (copy / "conf/model.conf").read_text().splitlines()
    assert lines[:4] == ["--other=1", "--beam=15.0", "--lattice-beam=8.0", "--max-active=7000"]
    assert "--endpoint.rule2.min-trailing-silence=60.0" in lines
    assert "--dither=0.0" in (copy / "conf/mfcc.conf").read_text().splitlines()
    assert models.tuned(folder, models.NARROW) != copy
    assert models.tuned(folder) == copy


def test_without_a_cache_the_model_itself_serves(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    folder = make_model(tmp_path / "mine")
    assert models.tuned(folder) == folder
