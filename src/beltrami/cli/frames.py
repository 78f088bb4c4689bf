"""Frames, one after the other, into one array, an animation, or a folder of pictures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from beltrami._arrays import Floats
    from beltrami._progress import Progress
    from beltrami.display.srgb import Image

Frames: TypeAlias = "Iterable[tuple[float, Floats]]"


def write_array(path: Path, frames: Frames, count: int, shape: tuple[int, ...]) -> None:
    """Write a .npy file of the shape (count, *shape), frame by frame."""
    import numpy as np

    from beltrami.io.atomic import replacing

    with replacing(path) as file:
        header = {"descr": "<f8", "fortran_order": False, "shape": (count, *shape)}
        np.lib.format.write_array_header_1_0(file, header)
        for _, frame in frames:
            file.write(np.ascontiguousarray(frame, "<f8").tobytes())


def write_pictures(
    path: Path, suffix: str, frames: Frames, draw: Callable[[float, Floats], Image], rate: float
) -> None:
    """Draw the frames into an animation, or as frame-0000.png and so on if there is no suffix."""
    from beltrami.display.images import write_animation, write_image

    images = (draw(time, frame) for time, frame in frames)
    if suffix:
        write_animation(path, images, rate)
        return
    path.mkdir(exist_ok=True)
    for k, image in enumerate(images):
        write_image(path / f"frame-{k:04}.png", image)


def largest(frames: Frames) -> float:
    """Return the largest absolute value in all frames."""
    import numpy as np

    return max((float(np.abs(frame).max()) for _, frame in frames), default=0.0)


def told(frames: Frames, progress: Progress, count: int) -> Iterator[tuple[float, Floats]]:
    """Tell the progress after each frame was used."""
    for k, frame in enumerate(frames):
        yield frame
        progress(k + 1, count)
