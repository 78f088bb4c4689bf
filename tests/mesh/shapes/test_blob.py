import numpy as np
import pytest

from beltrami.errors import MeshError
from beltrami.mesh.shapes import blob
from beltrami.mesh.shapes.anatomy import LOWER, UPPER, pose, skin
from beltrami.mesh.shapes.blob import LARGEST_BASE
from beltrami.mesh.shapes.implicit import field, project

SIZES = (500, 1000, 3000, 8000, 20_000)


@pytest.fixture(scope="module")
def blobs():
    return {n: blob(n) for n in SIZES}


@pytest.mark.parametrize("n", SIZES)
def test_closed_manifold_of_genus_zero_oriented_outward(survey, blobs, n):
    facts = survey(blobs[n])
    assert (facts.euler, facts.boundary_edges, facts.components) == (2, 0, 1)
    assert facts.is_manifold
    assert facts.volume > 0.08
    assert abs(blobs[n].n_vertices / n - 1) < 0.05


@pytest.mark.parametrize("n", SIZES)
def test_triangles_are_well_shaped(survey, blobs, n):
    angles = survey(blobs[n]).min_angles
    assert np.mean(angles < 15) < 0.005
    assert np.mean(angles) > 40
    assert angles.min() > 5


def test_count_is_that_of_a_base_subdivided(blobs):
    base = blob(int((20_000 - 2) / 4 + 2))
    assert base.n_vertices <= 1.05 * LARGEST_BASE
    assert blobs[20_000].n_vertices == 4 * (base.n_vertices - 2) + 2


def test_the_same_bits_each_time(blobs):
    again = blob(1000)
    assert np.array_equal(again.vertices, blobs[1000].vertices)
    assert np.array_equal(again.faces, blobs[1000].faces)


def test_area_and_volume_settle(survey, blobs):
    fine, coarse = survey(blobs[20_000]), survey(blobs[3000])
    assert coarse.area == pytest.approx(fine.area, rel=0.03)
    assert coarse.volume == pytest.approx(fine.volume, rel=0.03)


def test_size_and_pose(blobs):
    x, y, z = blobs[20_000].vertices.T
    assert 1.8 < np.ptp(x) < 2.6
    head, tail = np.argmax(x), np.argmin(x)
    assert y[head] > 0.1  # to its left
    assert y[tail] < -0.1
    assert z[head] > 0.3


def _creases(mesh):
    """Angles between the normals of the faces at each edge, in degrees, and the edges."""
    halves = mesh.topology.half_edges.twins.ravel()
    mine = np.flatnonzero(halves > np.arange(len(halves)))
    normals = mesh.face_normals
    cosine = (normals[mine // 3] * normals[halves[mine] // 3]).sum(axis=1)
    f, c = np.divmod(mine, 3)
    ends = np.stack([mesh.faces[f, (c + 1) % 3], mesh.faces[f, (c + 2) % 3]], axis=1)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1))), ends


def test_the_rim_of_the_crest_is_a_chain_of_sharp_edges_at_every_resolution(blobs):
    lengths = []
    for n in (3000, 20_000):
        mesh = blobs[n]
        angle, ends = _creases(mesh)
        sharp = ends[angle > 50]
        lengths.append(np.linalg.norm(np.subtract(*mesh.vertices[sharp.T]), axis=1).sum())
    fine_angle, _ = _creases(blobs[20_000])
    assert fine_angle.max() > 80
    assert lengths[1] > 1.0  # half the length of the creature, not a few stray edges


def test_thin_parts_are_there(blobs):
    """The neck is less than a quarter as wide as the trunk."""
    x, y, z = blobs[20_000].vertices.T
    neck = (z > 0.38) & (z < 0.42) & (x > 0)
    trunk = (np.abs(x) < 0.02) & (np.abs(y) < 0.25)
    assert neck.sum() > 20
    assert np.ptp(y[neck]) < 0.35 * np.ptp(y[trunk])


def test_pose_preserves_orientation_everywhere():
    rng = np.random.default_rng(118_250_933)
    points = project(rng.uniform(LOWER, UPPER, (500, 3)) * rng.choice([1, -1], (500, 1)), skin(), 9)
    points = points[np.abs(field(points, skin())[0]) < 1e-6]  # on the creature at rest
    assert len(points) > 300
    h = 1e-6
    columns = [(pose(points + h * e) - pose(points - h * e)) / (2 * h) for e in np.eye(3)]
    assert (np.linalg.det(np.stack(columns, axis=2)) > 0).all()


@pytest.mark.parametrize("bad", [499, 2.5e4, -1])
def test_bad_parameters(bad):
    with pytest.raises(MeshError, match="n_vertices"):
        blob(bad)


@pytest.mark.heavy
def test_half_a_million_vertices(survey):
    facts = survey(blob(537_000))
    assert (facts.euler, facts.boundary_edges, facts.components) == (2, 0, 1)
    assert facts.is_manifold
    assert np.mean(facts.min_angles < 15) < 0.005
