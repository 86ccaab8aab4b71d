"""The native step: the one thing about the package that pyproject.toml cannot say."""

from setuptools import setup

setup(cffi_modules=["tcs_hil/native/build.py:ffibuilder"])
