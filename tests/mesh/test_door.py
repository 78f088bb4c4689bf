import numpy as np
import pytest

import beltrami as bt
from beltrami.errors import DimensionError
from beltrami.mesh import door
from made_once import MadeOnce

BALL = bt.shapes.icosphere(1)
F = np.ones(BALL.n_vertices)
NOT_MESHES = MadeOnce(
    {
        "None": None,
        "pair of arrays": (BALL.vertices, BALL.faces),
        "lists": [[0.0, 1.0], [[0]]],
        "path": "bunny.obj",
        "array": BALL.vertices,
        "number": 3,
        "class": bt.Mesh,
        "Grid": bt.Grid((5, 6)),
        "Laplacian": lambda: bt.laplacian(BALL),
        "PointCloud": lambda: bt.PointCloud(BALL.vertices),
        "matrix": lambda: bt.laplacian(BALL).weights,
        "triangles": lambda: bt.intrinsic_delaunay(BALL),
    }
)
OF_A_MESH = {
    "areas": bt.vertex_areas,
    "edge areas": bt.edge_areas,
    "cells": lambda mesh: bt.edge_areas(mesh, "incenter"),
    "integral": lambda mesh: bt.integrate(mesh, F),
    "edge integral": lambda mesh: bt.integrate(mesh, F, "edge"),
    "curvature": bt.curvature,
    **{
        f"energy {how}": lambda mesh, how=how: bt.dirichlet_energy(mesh, F, how)
        for how in ("faces", "edges", "cotangent")
    },
    "slopes": lambda mesh: bt.edge_derivative(mesh, F),
    "gradient": bt.face_gradient,
    "divergence": bt.face_divergence,
    "flips": bt.intrinsic_delaunay,
    "cotangents": lambda mesh: bt.edge_weights(mesh, "cotangent"),
    "mean values": lambda mesh: bt.edge_weights(mesh, "mean_value"),
    **{
        f"distance {how}": lambda mesh, how=how: bt.geodesic_distance(mesh, 0, method=how)
        for how in ("heat", "exact", "edges")
    },
    "heat method": bt.HeatMethod,
    "smoothing": bt.smooth_mesh,
    "diagnosis": bt.diagnose,
    "repair": bt.repair,
    "picture": lambda mesh: bt.render(mesh, size=(8, 8)),
    "file": lambda mesh: bt.write_mesh("never_written.obj", mesh),
}
OF_A_TOPOLOGY = {
    "weights": lambda domain: bt.edge_weights(domain, "combinatorial"),
    "callable": lambda domain: bt.edge_weights(domain, lambda d: np.ones(len(d.edges))),
    "local": lambda domain: bt.is_local(np.eye(BALL.n_vertices), domain),
}


@pytest.mark.parametrize("thing", [*NOT_MESHES, "Topology"])
@pytest.mark.parametrize("name", OF_A_MESH)
def test_whatever_is_no_mesh_is_refused_in_one_line(name, thing):
    given = BALL.topology if thing == "Topology" else NOT_MESHES[thing]
    with pytest.raises(DimensionError, match="a Mesh is needed") as caught:
        OF_A_MESH[name](given)
    text = str(caught.value)
    assert "\n" not in text
    several = name == "picture" and isinstance(given, list | tuple)  # they may hold meshes
    kind = type(given[0] if several else given).__name__
    assert f"of type {kind}." in text or "class Mesh" in text or "a Topology has no" in text


@pytest.mark.parametrize("thing", NOT_MESHES)
@pytest.mark.parametrize("name", OF_A_TOPOLOGY)
def test_whatever_has_no_faces_is_refused_where_a_topology_is_enough(name, thing):
    OF_A_TOPOLOGY[name](BALL.topology)
    OF_A_TOPOLOGY[name](BALL)
    with pytest.raises(DimensionError, match="a Mesh or a Topology is needed"):
        OF_A_TOPOLOGY[name](NOT_MESHES[thing])


def test_the_line_says_for_what():
    assert door.require_mesh(BALL, "curvature") is BALL
    with pytest.raises(DimensionError, match="needed for distance weights: a Topology has no pos"):
        bt.edge_weights(BALL.topology, "distance")
    with pytest.raises(DimensionError, match="needed for the voronoi mass: a Topology has no pos"):
        bt.laplacian(BALL.topology, mass="voronoi")
    with pytest.raises(DimensionError, match="needed for the heat method, not an object of type"):
        bt.HeatMethod(bt.Grid((3, 3)))
