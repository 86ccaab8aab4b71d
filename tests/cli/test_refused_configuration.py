"""Nothing of the service's configuration is taken on trust: each key, through the command line."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import msgspec
import pytest
from cli.ended import TcsHil
from msgspec.structs import fields

from tcs_hil.model.bank import default_bank_path
from tcs_hil.model.bank_identification import identify_bank
from tcs_hil.model.bank_provenance import BandSettings, BankSettings
from tcs_hil.model.excitation import ExcitationSettings
from tcs_hil.service.settings import ServiceConfig

Keys = tuple[str, ...]
NO_BUS = "can77"
CORRUPTIONS: dict[str, Callable[[bytes], bytes]] = {
    "cut short": lambda content: content[: len(content) // 2],
    "emptied": lambda _: b"",
    "edited": lambda content: content.replace(b'"seed":', b'"seeb":', 1),
    "one bit flipped": lambda content: flipped(content, len(content) // 2),
}


@pytest.fixture
def refused(tcs_hil: TcsHil) -> TcsHil:
    """Start the service; what is not refused ends at a bus that is not there, and not never."""
    return partial(tcs_hil, "run", "--channel", NO_BUS)


def tables(struct: msgspec.Struct, keys: Keys = ()) -> Iterator[tuple[Keys, msgspec.Struct]]:
    yield keys, struct
    for field in fields(struct):
        if isinstance(value := getattr(struct, field.name), msgspec.Struct):
            yield from tables(value, (*keys, field.name))


def numbers() -> Iterator[tuple[Keys, str]]:
    """Every number of the configuration, with what no bound may let through."""
    for keys, struct in tables(ServiceConfig()):
        for field in fields(struct):
            value = getattr(struct, field.name)
            if isinstance(value, float):
                wrong = ("nan", "inf", "-inf", "1e300")
            elif isinstance(value, int) and not isinstance(value, bool):
                wrong = (str(2**62), "-1", "0.5")
            else:
                continue
            yield from (((*keys, field.name), text) for text in wrong)


def toml(keys: Keys, value: str) -> str:
    return f"{'.'.join(keys)} = {value}\n"


def flipped(content: bytes, place: int) -> bytes:
    return content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :]


@pytest.mark.parametrize("keys", [keys for keys, _ in tables(ServiceConfig())], ids=".".join)
def test_an_unknown_key_is_refused_in_every_table(
    refused: TcsHil, tmp_path: Path, keys: Keys
) -> None:
    path = tmp_path / "service.toml"
    path.write_text(toml((*keys, "torque_vectoring"), "true"))
    refusal = refused("--config", str(path))
    assert refusal.is_one_sentence_about(str(path), *keys, "unknown key `torque_vectoring`")


@pytest.mark.parametrize(("keys", "value"), list(numbers()), ids=str)
def test_a_number_out_of_its_bounds_is_refused(
    refused: TcsHil, tmp_path: Path, keys: Keys, value: str
) -> None:
    path = tmp_path / "service.toml"
    path.write_text(toml(keys, value))
    assert refused("--config", str(path)).is_one_sentence_about(str(path), ".".join(keys))


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ("[bus]\nbitrate = 2_000_000", "bus.bitrate"),
        ("[bus]\nchannel = ''", "bus.channel"),
        ("[bus]\ninterface = ' '", "bus.interface"),
        ("[tick]\ncpu = 4_000_000_000", "tick.cpu"),
        ("[tick]\ntrigger = 'whenever'", "tick.trigger"),
        ("controller = 'lqr'", "controller"),
        ("[control.default.nmpc]\nblocks = [1, 1, 9]", "control.default.nmpc.blocks"),
    ],
)
def test_a_choice_that_is_none_is_refused(
    refused: TcsHil, tmp_path: Path, text: str, key: str
) -> None:
    path = tmp_path / "service.toml"
    path.write_text(text)
    assert refused("--config", str(path)).is_one_sentence_about(str(path), key)


@pytest.mark.parametrize("key", ["model", "bus.database", "recorder.path"])
def test_a_path_no_file_can_have_is_refused(refused: TcsHil, tmp_path: Path, key: str) -> None:
    path = tmp_path / "service.toml"
    path.write_text(f'{key} = "a\\u0000b"')
    assert refused("--config", str(path)).is_one_sentence_about(str(path), key)


@pytest.mark.parametrize("damage", CORRUPTIONS)
def test_a_model_file_that_is_not_as_it_was_written_is_refused(
    refused: TcsHil, tmp_path: Path, damage: str
) -> None:
    path = tmp_path / "bank.npz"
    content = Path(default_bank_path()).read_bytes()
    path.write_bytes(CORRUPTIONS[damage](content))
    assert path.read_bytes() != content
    assert refused("--model", str(path)).is_one_sentence_about(str(path))


def test_the_shipped_model_file_passes_the_same_check(refused: TcsHil, tmp_path: Path) -> None:
    path = tmp_path / "bank.npz"
    shutil.copy(default_bank_path(), path)
    assert refused("--model", str(path)).is_one_sentence_about(NO_BUS)


def test_a_bank_made_for_another_sampling_time_is_refused(refused: TcsHil, tmp_path: Path) -> None:
    path = tmp_path / "bank.npz"
    tiny = BankSettings(
        period_s=0.001,
        bands=BandSettings(count=2),
        excitation=ExcitationSettings(runs=8, samples=40),
    )
    identify_bank(tiny, 1).save(path)
    assert refused("--model", str(path)).is_one_sentence_about(str(path), "0.001 s, not 0.002 s")


@pytest.mark.parametrize("period_s", [0.001, 0.004])
def test_a_period_that_is_not_the_cycle_of_the_limits_is_refused(
    refused: TcsHil, tmp_path: Path, period_s: float
) -> None:
    path = tmp_path / "service.toml"
    path.write_text(f"controller = 'pi'\n[control]\nperiod_s = {period_s}")
    refusal = refused("--config", str(path))
    assert refusal.is_one_sentence_about("control.period_s", str(period_s), "TorqueLimit")
