"""The operators as tensors: shapes, types, devices and gradients; nothing is trained."""

import functools
import sys
from dataclasses import fields

import numpy as np
import pytest
from scipy.sparse import issparse

import beltrami as bt
from beltrami.errors import MeshError, MissingExtraError, UnknownNameError
from beltrami.learning.operators import LearningOperators


@functools.cache
def operators():
    return bt.learning_operators(bt.shapes.torus(12, 7), 20)


def test_without_torch_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "torch", None)
    with pytest.raises(MissingExtraError, match=r"beltrami\[learning\]"):
        operators().to("torch")


@pytest.mark.parametrize("call", [("tensorflow", {}), ("torch", {"dtype": "int8"})])
def test_other_names(call):
    with pytest.raises(UnknownNameError):
        operators().to(call[0], **call[1])


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_shapes_types_and_numbers(dtype):
    torch = pytest.importorskip("torch")
    tensors = operators().to("torch", dtype=dtype)
    for field in fields(LearningOperators):
        array, tensor = getattr(operators(), field.name), getattr(tensors, field.name)
        assert tensor.dtype == getattr(torch, dtype)
        assert tensor.device == torch.device("cpu")
        assert tuple(tensor.shape) == array.shape
        assert not tensor.requires_grad
        if issparse(array):
            assert tensor.layout == torch.sparse_coo
            assert tensor.is_coalesced()
            tensor, array = tensor.to_dense(), array.toarray()
        assert np.array_equal(tensor.numpy(), array.astype(dtype))
    before = operators().masses.copy()
    tensors.masses.zero_()
    assert np.array_equal(operators().masses, before)


def test_devices_and_types_of_torch():
    torch = pytest.importorskip("torch")
    moved = operators().to("torch", dtype="float64").to("meta")
    assert {getattr(moved, field.name).device.type for field in fields(moved)} == {"meta"}
    assert moved.masses.dtype == torch.float64
    for dtype in (torch.float32, torch.float64):
        assert operators().to("torch", dtype=dtype).masses.dtype == dtype
    with pytest.raises(UnknownNameError, match="float32"):
        operators().to("torch", dtype=torch.float16)
    for device in ("meta", torch.device("meta")):  # the one that every machine has
        tensors = operators().to("torch", device=device)
        for field in fields(LearningOperators):
            assert getattr(tensors, field.name).device.type == "meta"


def block(x, time, turn, mass, L, evals, evecs, gradX, gradY):
    """A block of DiffusionNet: learned diffusion, gradients, their products; L in an energy."""
    torch = sys.modules["torch"]
    spectrum = evecs.T @ (x * mass[:, None])
    diffused = evecs @ (torch.exp(-evals[:, None] * time) * spectrum)
    a, b = torch.mm(gradX, diffused), torch.mm(gradY, diffused)
    features = torch.tanh(a * (a @ turn) + b * (b @ turn))
    return features.sum() + (diffused * torch.mm(L, diffused)).sum()


def test_gradients_flow_through_the_operators():
    torch = pytest.importorskip("torch")
    torch.manual_seed(0)
    arguments = operators().to("torch", dtype="float64").arguments
    x = torch.randn(operators().n, 3, dtype=torch.float64, requires_grad=True)
    time = torch.full((3,), 0.1, dtype=torch.float64, requires_grad=True)
    turn = torch.randn(3, 3, dtype=torch.float64, requires_grad=True)
    value = block(x, time, turn, **arguments)
    value.backward()
    for given in (x, time, turn):
        assert torch.isfinite(given.grad).all()
        assert given.grad.abs().max() > 0
        with torch.no_grad():  # against a difference along a random direction
            step = 1e-6 * torch.randn_like(given)
            others = [other if other is not given else None for other in (x, time, turn)]
            ahead = block(*(given + step if o is None else o for o in others), **arguments)
            behind = block(*(given - step if o is None else o for o in others), **arguments)
        along = (given.grad * step).sum().item()
        assert (ahead - behind).item() / 2 == pytest.approx(along, rel=1e-5)


def test_on_a_graphics_card_they_give_the_same():
    torch = pytest.importorskip("torch")
    if not torch.cuda.is_available():
        pytest.skip("no graphics card of CUDA here")
    found = []
    for device in ("cpu", "cuda"):
        tensors = operators().to("torch", device=device, dtype="float64")
        for field in fields(LearningOperators):
            assert getattr(tensors, field.name).device.type == device
        torch.manual_seed(0)
        x, turn = torch.randn(operators().n, 3).double(), torch.randn(3, 3).double()
        x, turn = (given.to(device).requires_grad_() for given in (x, turn))
        time = torch.full((3,), 0.1, dtype=torch.float64, device=device, requires_grad=True)
        value = block(x, time, turn, **tensors.arguments)
        value.backward()
        found.append([value.item(), *(given.grad.cpu() for given in (x, time, turn))])
    for ours, other in zip(*found, strict=True):
        assert other == pytest.approx(ours, rel=1e-9, abs=1e-12)


def test_a_batch_axis_can_be_added():
    pytest.importorskip("torch")
    tensors = operators().to("torch")
    assert tensors.gradient_x.unsqueeze(0)[0].is_sparse
    assert repr(tensors).startswith("<Tensors: 84 vertices, 20 eigenpairs, torch.float32")


def test_units_that_float32_cannot_hold_are_refused():
    pytest.importorskip("torch")
    torus = bt.shapes.torus(12, 7)
    for unit in (1e-25, 1e25):
        tiny = bt.learning_operators(bt.Mesh(torus.vertices * unit, torus.faces), 3)
        with pytest.raises(MeshError, match="float32"):
            tiny.to("torch")
        tiny.to("torch", dtype="float64")
