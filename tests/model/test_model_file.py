"""Model files: the same bytes for the same content, and a sentence for every bad one."""

from __future__ import annotations

import hashlib
import zipfile
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tcs_hil.errors import ModelError
from tcs_hil.model import archive
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path

PERIOD_S = 0.002
SHIPPED = default_model_path()


def load(path: Path) -> KoopmanPredictor:
    return KoopmanPredictor.load(path, PERIOD_S)


def loaded_or_refused(path: Path) -> KoopmanPredictor | str:
    try:
        return load(path)
    except ModelError as error:
        return str(error)


def rewritten(path: Path, drop: str = "", **changes: bytes) -> Path:
    """Copy of the shipped file without one member, or with members replaced."""
    with zipfile.ZipFile(SHIPPED) as source, zipfile.ZipFile(path, "w") as target:
        for name in source.namelist():
            if name != drop:
                target.writestr(name, changes.get(name.partition(".")[0], source.read(name)))
    return path


def resealed(path: Path, metadata: dict[str, object], **arrays: np.ndarray) -> Path:
    """Copy of the shipped file with altered content and a digest that fits it."""
    old_metadata, old_arrays = archive.read(SHIPPED)
    new_metadata = msgspec.json.decode(old_metadata) | metadata
    archive.write(path, msgspec.json.encode(new_metadata), old_arrays | arrays)
    return path


def test_saving_and_loading_changes_nothing(paper, tmp_path):
    paper.save(tmp_path / "copy.npz")
    copy = load(tmp_path / "copy.npz")
    np.testing.assert_array_equal(copy.a, paper.a)
    np.testing.assert_array_equal(copy.b, paper.b)
    assert copy.provenance == paper.provenance


def test_the_same_predictor_gives_the_same_bytes(paper, tmp_path):
    paper.save(tmp_path / "copy.npz")
    assert (tmp_path / "copy.npz").read_bytes() == SHIPPED.read_bytes()


def test_numpy_opens_the_file_too(paper):
    with np.load(SHIPPED) as file:
        np.testing.assert_array_equal(file["a"], paper.a)


def test_loaded_matrices_cannot_be_written_to(paper):
    with pytest.raises(ValueError, match="read-only"):
        paper.a[0, 0] = 1.0


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ModelError, match=r"none\.npz' cannot be read: No such file"):
        load(tmp_path / "none.npz")


def test_a_directory_that_is_not_there_is_named(paper, tmp_path):
    with pytest.raises(ModelError, match=r"copy\.npz' cannot be written"):
        paper.save(tmp_path / "nowhere" / "copy.npz")


def test_another_sampling_time_is_refused():
    with pytest.raises(ModelError, match=r"paper\.npz' is for a period of 0\.002 s, not 0\.005 s"):
        KoopmanPredictor.load(SHIPPED, 0.005)


@pytest.mark.parametrize("length", [0, 10, 2000, -1])
def test_a_cut_file_is_refused(tmp_path, length):
    (tmp_path / "cut.npz").write_bytes(SHIPPED.read_bytes()[:length])
    with pytest.raises(ModelError, match=r"cut\.npz' is damaged"):
        load(tmp_path / "cut.npz")


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(position=st.integers(0, SHIPPED.stat().st_size - 1), flip=st.integers(1, 255))
def test_a_flipped_byte_is_refused_or_harmless(paper, tmp_path, position, flip):
    content = bytearray(SHIPPED.read_bytes())
    content[position] ^= flip
    (tmp_path / "flipped.npz").write_bytes(content)
    outcome = loaded_or_refused(tmp_path / "flipped.npz")
    if isinstance(outcome, str):
        assert "flipped.npz" in outcome
    else:  # the bit stood in a date, say
        np.testing.assert_array_equal(outcome.a, paper.a)
        np.testing.assert_array_equal(outcome.b, paper.b)
        assert outcome.provenance == paper.provenance


def test_an_edited_file_is_refused(tmp_path):
    metadata, _ = archive.read(SHIPPED)
    edited = rewritten(
        tmp_path / "e.npz", metadata=metadata.replace(b'"seed": 2024', b'"seed": 2025')
    )
    with pytest.raises(ModelError, match=r"e\.npz' was altered after it was written"):
        load(edited)


@pytest.mark.parametrize("member", ["sha256", "metadata.json"])
def test_a_file_without_digest_or_metadata_is_incomplete(tmp_path, member):
    with pytest.raises(ModelError, match=r"i\.npz' is incomplete"):
        load(rewritten(tmp_path / "i.npz", drop=member))


def test_a_compressed_copy_is_not_ours(tmp_path):
    with zipfile.ZipFile(tmp_path / "z.npz", "w", zipfile.ZIP_DEFLATED) as target:
        target.writestr("a.npy", b"0" * 100)
    with pytest.raises(ModelError, match=r"z\.npz' is damaged or not a model file"):
        load(tmp_path / "z.npz")


def test_a_file_with_other_arrays_is_refused(paper, tmp_path):
    other = resealed(tmp_path / "o.npz", {}, d=paper.a)
    with pytest.raises(ModelError, match=r"o\.npz' holds \['a', 'b', 'd'\]"):
        load(other)


def test_an_unknown_layout_is_refused_before_its_content_is_judged(tmp_path):
    future = resealed(tmp_path / "f.npz", {"layout_version": 99, "surprise": True})
    with pytest.raises(ModelError, match=r"f\.npz' has layout 99, this version reads 2"):
        load(future)


@pytest.mark.parametrize(
    "metadata",
    [{"surprise": True}, {"seed": "many"}, {"layout_version": None}, {"period_s": -1.0}],
)
def test_metadata_that_make_no_sense_are_refused(tmp_path, metadata):
    with pytest.raises(ModelError, match=r"m\.npz' has bad metadata"):
        load(resealed(tmp_path / "m.npz", metadata))


def test_metadata_that_are_not_text_are_refused(tmp_path):
    _, arrays = archive.read(SHIPPED)
    archive.write(tmp_path / "u.npz", b'{"layout_version": "\xff"}', arrays)
    with pytest.raises(ModelError, match=r"u\.npz' has bad metadata"):
        load(tmp_path / "u.npz")


@pytest.mark.parametrize("metadata", [{"order": 3}, {"order": 0}, {"dictionary": "splines"}])
def test_a_dictionary_that_does_not_fit_the_matrices_is_refused(tmp_path, metadata):
    with pytest.raises(ModelError, match=r"d\.npz' is inconsistent"):
        load(resealed(tmp_path / "d.npz", metadata))


def test_an_array_of_something_else_is_refused(tmp_path):
    words = resealed(tmp_path / "w.npz", {}, a=np.array(["a", "b"]))
    with pytest.raises(ModelError, match=r"w\.npz' holds an unreadable array"):
        load(words)


def test_the_papers_matrices_are_bit_for_bit_those_its_figures_were_made_with(paper):
    content = hashlib.sha256(paper.a.tobytes() + paper.b.tobytes()).hexdigest()
    assert content == "db678611039ffa70136373fdd936232de19d0ab5f20b23b1cfb8f1593088ed68"
