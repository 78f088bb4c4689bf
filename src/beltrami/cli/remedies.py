"""Remedies of the library, said in the words of the command line."""

from __future__ import annotations

import inspect
import re

_BASIS = "--basis with modes of `beltrami spectrum` if the kernel"


def as_commands(text: str) -> str:
    """Turn calls and keywords in a message into the commands and options that do the same.

    Examples
    --------
    >>> as_commands("Drop them with repair(mesh, remove_unreferenced=True).")
    'Drop them with `beltrami repair --remove-unreferenced`.'
    >>> as_commands("repair: split_non_manifold cuts there; remove_duplicate_faces first.")
    '`beltrami repair --split-non-manifold` cuts there; --remove-duplicate-faces first.'
    >>> as_commands("repair: orient turns faces until neighbours agree.")
    '`beltrami repair --orient` turns faces until neighbours agree.'
    >>> as_commands('Use laplacian(mesh, "combinatorial") or "distance", or heat(), not this.')
    'Use --weights combinatorial or distance, or --method implicit, not this.'
    >>> as_commands('Or use method="heat".')
    'Or use --method heat.'
    >>> as_commands('Allow it with cut=True, take boundary="circle", or bend it (bulge=0.01).')
    'Allow it by leaving out --no-cut, take --boundary circle, or bend it (--bulge 0.01).'
    >>> as_commands("strict=False returns the map as it is.")
    '--allow-folds writes the map as it is.'
    """
    text = re.sub(r"repair\(mesh, ([^)]*)\)", _call, text)
    text = re.sub(rf"\brepair: (orient|{_repairs()})\b", _command, text)
    text = re.sub(rf"\b({_repairs()})(=True)?\b(?!\s*=)", lambda found: _option(found[1]), text)
    text = re.sub(r'laplacian\(mesh, "(\w+)"\) or "(\w+)"', r"--weights \1 or \2", text)
    text = re.sub(r'\b(method|weights|mass|boundary|keep)="(\w+)"', r"--\1 \2", text)
    text = re.sub(r"\bbulge=([\d.]+\d)", r"--bulge \1", text)
    text = text.replace("fourier_basis(laplacian, k).filter(f, h) if h", _BASIS)
    text = text.replace("; or give the order, and nothing is promised", "")
    text = text.replace("hold_boundary=True", "--hold-boundary")
    text = text.replace("with cut=True", "by leaving out --no-cut")
    text = text.replace("strict=False returns", "--allow-folds writes")
    return text.replace("heat()", "--method implicit")


def _repairs() -> str:
    """Return the names of the repairs that cannot be words of a sentence, as alternatives."""
    from beltrami.mesh.repair import repair

    return "|".join([name for name in inspect.signature(repair).parameters if "_" in name])


def _call(call: re.Match[str]) -> str:
    options = " ".join(_option(name) for name in re.findall(r"(\w+)=", call[1]))
    return f"`beltrami repair {options}`"


def _command(found: re.Match[str]) -> str:
    return f"`beltrami repair {_option(found[1])}`"


def _option(name: str) -> str:
    return "--" + name.replace("_", "-")
