"""The backends that are installed here, as parameters of tests."""

from __future__ import annotations

from importlib.util import find_spec

import pytest

PACKAGES = {"cholespy": "cholespy", "cholmod": "sksparse", "pardiso": "pypardiso"}
DEFINITE = ("cholesky", "cholespy", "cholmod")  # those that take nothing else
SYMMETRIC = (*DEFINITE, "ldl")


def backend(name, *rest):
    missing = name in PACKAGES and find_spec(PACKAGES[name]) is None
    reason = f"{PACKAGES.get(name)} is not installed"
    return pytest.param(name, *rest, marks=pytest.mark.skipif(missing, reason=reason))


EVERY = [backend(name) for name in ("cholesky", "ldl", "superlu", *PACKAGES)]
