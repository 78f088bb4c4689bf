"""Fourier analysis and linear processing of functions on triangle meshes.

Everything is one pair of matrices: a stiffness L and a mass B, which ``laplacian`` makes of a
mesh, a topology or a graph. Names are loaded when they are first used.

Examples
--------
>>> import beltrami as bt
>>> mesh = bt.shapes.icosphere(2)
>>> smoother = bt.smooth_mesh(mesh, steps=5, keep="volume")
>>> bt.laplacian(smoother)
<Laplacian: 162 vertices, cotangent weights, (cot α + cot β)/2, voronoi mass,
 positive semi-definite>
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from beltrami._carded import register_drawer
from beltrami._collector import resting_collector

if TYPE_CHECKING:
    from beltrami import datasets as datasets
    from beltrami import errors as errors
    from beltrami.batch.rows import write_rows as write_rows
    from beltrami.batch.run_batch import Batch as Batch
    from beltrami.batch.run_batch import run_batch as run_batch
    from beltrami.compression.compress import compress as compress
    from beltrami.compression.compress import vertex_order as vertex_order
    from beltrami.compression.decompress import decompress as decompress
    from beltrami.diffusion.bumps import gaussian_bumps as gaussian_bumps
    from beltrami.diffusion.denoise import denoise as denoise
    from beltrami.diffusion.denoise_function import DenoisedFunction as DenoisedFunction
    from beltrami.diffusion.denoise_function import denoise_function as denoise_function
    from beltrami.diffusion.denoised import Denoised as Denoised
    from beltrami.diffusion.heat import heat as heat
    from beltrami.diffusion.interpolate import interpolate as interpolate
    from beltrami.diffusion.poisson import poisson as poisson
    from beltrami.diffusion.regularize import regularize as regularize
    from beltrami.diffusion.smooth_mesh import smooth_mesh as smooth_mesh
    from beltrami.diffusion.smoothing import smooth as smooth
    from beltrami.diffusion.wave import wave as wave
    from beltrami.display.bake import bake as bake
    from beltrami.display.bake import colorize as colorize
    from beltrami.display.light import DirectionalLight as DirectionalLight
    from beltrami.display.light import SpotLight as SpotLight
    from beltrami.display.page import Page as Page
    from beltrami.display.page import page as page
    from beltrami.display.render import render as render
    from beltrami.display.spectrum_plot import plot_spectrum as plot_spectrum
    from beltrami.geodesics.distance import geodesic_distance as geodesic_distance
    from beltrami.geodesics.heat_method import HeatMethod as HeatMethod
    from beltrami.grids.convolution import convolve as convolve
    from beltrami.grids.grid import Grid as Grid
    from beltrami.grids.transform import dft as dft
    from beltrami.grids.transform import idft as idft
    from beltrami.io.function import read_function as read_function
    from beltrami.io.function_write import write_function as write_function
    from beltrami.io.points import read_points as read_points
    from beltrami.io.registry import read_mesh as read_mesh
    from beltrami.io.registry import write_mesh as write_mesh
    from beltrami.learning.learning_operators import learning_operators as learning_operators
    from beltrami.learning.operators import LearningOperators as LearningOperators
    from beltrami.mesh import shapes as shapes
    from beltrami.mesh.convert import as_mesh as as_mesh
    from beltrami.mesh.cut import Cut as Cut
    from beltrami.mesh.diagnose import Diagnosis as Diagnosis
    from beltrami.mesh.diagnose import diagnose as diagnose
    from beltrami.mesh.mesh import Mesh as Mesh
    from beltrami.mesh.repair import Repair as Repair
    from beltrami.mesh.repair import repair as repair
    from beltrami.mesh.topology import Topology as Topology
    from beltrami.mesh.tree_cotree import cut_to_disk as cut_to_disk
    from beltrami.operators.areas import vertex_areas as vertex_areas
    from beltrami.operators.colouring import colouring as colouring
    from beltrami.operators.curvature import Curvature as Curvature
    from beltrami.operators.curvature import curvature as curvature
    from beltrami.operators.differences import edge_derivative as edge_derivative
    from beltrami.operators.edge_areas import edge_areas as edge_areas
    from beltrami.operators.energy import dirichlet_energy as dirichlet_energy
    from beltrami.operators.gradient import face_divergence as face_divergence
    from beltrami.operators.gradient import face_gradient as face_gradient
    from beltrami.operators.integrals import integrate as integrate
    from beltrami.operators.intrinsic import IntrinsicTriangulation as IntrinsicTriangulation
    from beltrami.operators.intrinsic import intrinsic_delaunay as intrinsic_delaunay
    from beltrami.operators.laplacian import laplacian as laplacian
    from beltrami.operators.locality import is_local as is_local
    from beltrami.operators.neighbours import knn_graph as knn_graph
    from beltrami.operators.pair import Laplacian as Laplacian
    from beltrami.operators.partition import RowBlock as RowBlock
    from beltrami.operators.partition import gather_rows as gather_rows
    from beltrami.operators.partition import partition_rows as partition_rows
    from beltrami.operators.point_cloud import PointCloud as PointCloud
    from beltrami.operators.projection import project as project
    from beltrami.operators.weights import edge_weights as edge_weights
    from beltrami.parameterization.atlas import atlas as atlas
    from beltrami.parameterization.certificate import Certificate as Certificate
    from beltrami.parameterization.certificate import certify as certify
    from beltrami.parameterization.disk_cells import DiskCells as DiskCells
    from beltrami.parameterization.disk_cells import segment_into_disks as segment_into_disks
    from beltrami.parameterization.distortion import Distortion as Distortion
    from beltrami.parameterization.distortion import distortion as distortion
    from beltrami.parameterization.flatten import flatten as flatten
    from beltrami.parameterization.harmonic import harmonic as harmonic
    from beltrami.parameterization.parameterization import Parameterization as Parameterization
    from beltrami.parameterization.parameterize import parameterize as parameterize
    from beltrami.parameterization.texture_atlas import TextureAtlas as TextureAtlas
    from beltrami.solvers.conjugate_gradients import conjugate_gradients as conjugate_gradients
    from beltrami.solvers.factor import Factor as Factor
    from beltrami.solvers.factorize import factorize as factorize
    from beltrami.solvers.inverse_iteration import InverseIteration as InverseIteration
    from beltrami.solvers.iteration import IterativeSolution as IterativeSolution
    from beltrami.solvers.minres import minres as minres
    from beltrami.spectrum import kernels as kernels
    from beltrami.spectrum.basis import FourierBasis as FourierBasis
    from beltrami.spectrum.correspondence import FunctionalMap as FunctionalMap
    from beltrami.spectrum.correspondence import (
        functional_map_from_points as functional_map_from_points,
    )
    from beltrami.spectrum.distances import spectral_distance as spectral_distance
    from beltrami.spectrum.distances import spectral_embedding as spectral_embedding
    from beltrami.spectrum.filtering import filter as filter  # noqa: A004
    from beltrami.spectrum.fourier_basis import fourier_basis as fourier_basis
    from beltrami.spectrum.frames import Frame as Frame
    from beltrami.spectrum.functional_map import functional_map as functional_map
    from beltrami.spectrum.heat_kernel import heat_kernel_signature as heat_kernel_signature
    from beltrami.spectrum.inverse_iteration import inverse_iteration as inverse_iteration
    from beltrami.spectrum.load_basis import load_basis as load_basis
    from beltrami.spectrum.nodal_domains import NodalDomains as NodalDomains
    from beltrami.spectrum.nodal_domains import nodal_domains as nodal_domains
    from beltrami.spectrum.segment import Segmentation as Segmentation
    from beltrami.spectrum.segment import segment as segment
    from beltrami.spectrum.shape_dna import shape_dna as shape_dna
    from beltrami.spectrum.signature import Signature as Signature
    from beltrami.spectrum.wave_kernel import wave_kernel_signature as wave_kernel_signature
    from beltrami.spectrum.wavelets import mexican_hat_frame as mexican_hat_frame
    from beltrami.spectrum.wavelets import meyer_frame as meyer_frame
    from beltrami.spectrum.zoomout import zoomout as zoomout
    from beltrami.surfaces.atlas import Atlas as Atlas
    from beltrami.surfaces.ball_average import ball_average_laplacian as ball_average_laplacian
    from beltrami.surfaces.domain import Disk as Disk
    from beltrami.surfaces.domain import Rectangle as Rectangle
    from beltrami.surfaces.geodesics import exponential_map as exponential_map
    from beltrami.surfaces.surface import ParametricSurface as ParametricSurface

__version__ = "0.1.0"

register_drawer("beltrami.display.cards")  # no room on the way there may import it

_HOME = {
    "Atlas": "surfaces.atlas",
    "Batch": "batch.run_batch",
    "Certificate": "parameterization.certificate",
    "Curvature": "operators.curvature",
    "Cut": "mesh.cut",
    "Denoised": "diffusion.denoised",
    "DenoisedFunction": "diffusion.denoise_function",
    "Diagnosis": "mesh.diagnose",
    "DirectionalLight": "display.light",
    "Disk": "surfaces.domain",
    "DiskCells": "parameterization.disk_cells",
    "Distortion": "parameterization.distortion",
    "Factor": "solvers.factor",
    "FourierBasis": "spectrum.basis",
    "Frame": "spectrum.frames",
    "FunctionalMap": "spectrum.correspondence",
    "Grid": "grids.grid",
    "HeatMethod": "geodesics.heat_method",
    "IntrinsicTriangulation": "operators.intrinsic",
    "InverseIteration": "solvers.inverse_iteration",
    "IterativeSolution": "solvers.iteration",
    "Laplacian": "operators.pair",
    "LearningOperators": "learning.operators",
    "Mesh": "mesh.mesh",
    "NodalDomains": "spectrum.nodal_domains",
    "Page": "display.page",
    "Parameterization": "parameterization.parameterization",
    "ParametricSurface": "surfaces.surface",
    "PointCloud": "operators.point_cloud",
    "Rectangle": "surfaces.domain",
    "Repair": "mesh.repair",
    "RowBlock": "operators.partition",
    "Segmentation": "spectrum.segment",
    "Signature": "spectrum.signature",
    "SpotLight": "display.light",
    "TextureAtlas": "parameterization.texture_atlas",
    "Topology": "mesh.topology",
    "as_mesh": "mesh.convert",
    "atlas": "parameterization.atlas",
    "bake": "display.bake",
    "ball_average_laplacian": "surfaces.ball_average",
    "certify": "parameterization.certificate",
    "colorize": "display.bake",
    "colouring": "operators.colouring",
    "compress": "compression.compress",
    "conjugate_gradients": "solvers.conjugate_gradients",
    "convolve": "grids.convolution",
    "curvature": "operators.curvature",
    "cut_to_disk": "mesh.tree_cotree",
    "decompress": "compression.decompress",
    "denoise": "diffusion.denoise",
    "denoise_function": "diffusion.denoise_function",
    "dft": "grids.transform",
    "diagnose": "mesh.diagnose",
    "dirichlet_energy": "operators.energy",
    "distortion": "parameterization.distortion",
    "edge_areas": "operators.edge_areas",
    "edge_derivative": "operators.differences",
    "edge_weights": "operators.weights",
    "exponential_map": "surfaces.geodesics",
    "face_divergence": "operators.gradient",
    "face_gradient": "operators.gradient",
    "factorize": "solvers.factorize",
    "filter": "spectrum.filtering",
    "flatten": "parameterization.flatten",
    "fourier_basis": "spectrum.fourier_basis",
    "functional_map": "spectrum.functional_map",
    "functional_map_from_points": "spectrum.correspondence",
    "gather_rows": "operators.partition",
    "gaussian_bumps": "diffusion.bumps",
    "geodesic_distance": "geodesics.distance",
    "harmonic": "parameterization.harmonic",
    "heat": "diffusion.heat",
    "heat_kernel_signature": "spectrum.heat_kernel",
    "idft": "grids.transform",
    "integrate": "operators.integrals",
    "interpolate": "diffusion.interpolate",
    "intrinsic_delaunay": "operators.intrinsic",
    "inverse_iteration": "spectrum.inverse_iteration",
    "is_local": "operators.locality",
    "knn_graph": "operators.neighbours",
    "laplacian": "operators.laplacian",
    "learning_operators": "learning.learning_operators",
    "load_basis": "spectrum.load_basis",
    "mexican_hat_frame": "spectrum.wavelets",
    "meyer_frame": "spectrum.wavelets",
    "minres": "solvers.minres",
    "nodal_domains": "spectrum.nodal_domains",
    "page": "display.page",
    "parameterize": "parameterization.parameterize",
    "partition_rows": "operators.partition",
    "plot_spectrum": "display.spectrum_plot",
    "poisson": "diffusion.poisson",
    "project": "operators.projection",
    "read_function": "io.function",
    "read_mesh": "io.registry",
    "read_points": "io.points",
    "regularize": "diffusion.regularize",
    "render": "display.render",
    "repair": "mesh.repair",
    "run_batch": "batch.run_batch",
    "segment": "spectrum.segment",
    "segment_into_disks": "parameterization.disk_cells",
    "shape_dna": "spectrum.shape_dna",
    "smooth": "diffusion.smoothing",
    "smooth_mesh": "diffusion.smooth_mesh",
    "spectral_distance": "spectrum.distances",
    "spectral_embedding": "spectrum.distances",
    "vertex_areas": "operators.areas",
    "vertex_order": "compression.compress",
    "wave": "diffusion.wave",
    "wave_kernel_signature": "spectrum.wave_kernel",
    "write_function": "io.function_write",
    "write_mesh": "io.registry",
    "write_rows": "batch.rows",
    "zoomout": "spectrum.zoomout",
}
_MODULES = {
    "datasets": "datasets",
    "errors": "errors",
    "kernels": "spectrum.kernels",
    "shapes": "mesh.shapes",
}

__all__ = sorted([*_HOME, *_MODULES])


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used (PEP 562)."""
    if name in _MODULES:
        with resting_collector:
            return importlib.import_module(f"beltrami.{_MODULES[name]}")
    if name not in _HOME:
        raise AttributeError(f"module 'beltrami' has no attribute {name!r}")
    with resting_collector:
        value = getattr(importlib.import_module(f"beltrami.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
