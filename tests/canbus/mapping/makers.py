"""Three invented makers, as the tests meet them."""

from .aurelis import AURELIS
from .car import FOLDER, GRAVITY_MPS2, KMPH, Car, Maker, crc8
from .montane import MONTANE
from .quendal import QUENDAL

__all__ = [
    "AURELIS",
    "FOLDER",
    "GRAVITY_MPS2",
    "KMPH",
    "MAKERS",
    "MONTANE",
    "QUENDAL",
    "Car",
    "Maker",
    "crc8",
]

MAKERS = (MONTANE, QUENDAL, AURELIS)
