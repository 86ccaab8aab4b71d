"""MF4 (ASAM MDF 4): channel groups of each message, the telemetry, the truth, and the frames."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final
from xml.etree import ElementTree

import can
import numpy as np
from asammdf import MDF, Signal
from asammdf.blocks.source_utils import Source
from can.io.mf4 import STD_DTYPE

from tcs_hil.hil.export.table import NS_PER_S, Channel, Run, Table

DEFLATE_TRANSPOSED: Final = 2
"""Transposed columns compress best; asammdf's number for it."""


def write(path: Path, run: Run) -> None:
    """Write the decoded run; value tables become conversions that read as text."""
    with MDF(version="4.10") as mdf:
        mdf.header.start_time = run.start
        mdf.header.comment = _header_comment(run.description)
        for table in run.decoded:
            _append(mdf, table)
        if run.frames:
            _append_frames(mdf, run.frames)
        mdf.save(path, overwrite=True, compression=DEFLATE_TRANSPOSED)


def _header_comment(description: Mapping[str, str]) -> str:
    """The XML in which MDF 4 keeps properties of a file."""
    root = ElementTree.Element("HDcomment")
    ElementTree.SubElement(root, "TX").text = "A run of tcs-hil"
    properties = ElementTree.SubElement(root, "common_properties")
    for name, text in description.items():
        ElementTree.SubElement(properties, "e", name=name).text = text
    return ElementTree.tostring(root, encoding="unicode")


def _append(mdf: MDF, table: Table) -> None:
    time_s = table.time_ns / NS_PER_S
    signals = [
        Signal(
            samples=channel.values,
            timestamps=time_s,
            name=table.full_name(channel),
            unit=channel.unit,
            comment=channel.comment,
            conversion=_conversion(channel),
        )
        for channel in table.channels
    ]
    mdf.append(signals, acq_name=table.name, comment=table.comment, common_timebase=True)


def _append_frames(mdf: MDF, frames: Sequence[can.Message]) -> None:
    """The bus as it was, as bus loggers put it and python-can reads it."""
    rows = np.zeros(len(frames), STD_DTYPE)
    for row, frame in zip(rows, frames, strict=True):
        row["CAN_DataFrame.ID"] = frame.arbitration_id
        row["CAN_DataFrame.IDE"] = frame.is_extended_id
        row["CAN_DataFrame.DLC"] = frame.dlc
        row["CAN_DataFrame.DataLength"] = len(frame.data)
        row["CAN_DataFrame.DataBytes"][: len(frame.data)] = frame.data
    bus = Source("CAN", "CAN", "", Source.SOURCE_BUS, Source.BUS_TYPE_CAN)
    time_s = np.array([frame.timestamp for frame in frames])
    mdf.append(Signal(rows, time_s, name="CAN_DataFrame", source=bus))


def _conversion(channel: Channel) -> dict[str, object] | None:
    """Value to text; what carries no label reads as the number it is."""
    if not channel.labels:
        return None
    as_it_is = {"a": 1.0, "b": 0.0}
    conversion: dict[str, object] = {"default_addr": as_it_is}
    for index, (value, label) in enumerate(channel.labels.items()):
        conversion |= {f"val_{index}": value, f"text_{index}": label}
    return conversion
