# SPDX-License-Identifier: BSD-2-Clause
"""Cameras in the library's and in gsplat's conventions."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from . import _structs as s
from ._numpy import Float64, numpy


@dataclass(frozen=True)
class Camera:
    """A pinhole camera. Axes are OpenCV's, like gsplat's: x right, y down, looking along +z; the centre of the first pixel is
    at (0.5, 0.5).

    width, height   pixels, 1 to 16384
    fx, fy, cx, cy  pixels
    cam_to_world    12 numbers, row-major 3x4 [R|c]: R orthonormal, c the camera's centre in world units
    near_plane      world units, above 0: nothing closer is rendered
    name            at most 63 bytes
    time            seconds at which a stored camera filmed, or None
    path            number of the filmed path that a stored camera is a key of, or None
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    cam_to_world: Sequence[float]
    near_plane: float = 0.01
    name: str = ""
    time: float | None = None
    path: int | None = None

    @classmethod
    def from_gsplat(cls, viewmat: Any, K: Any, width: int, height: int, near_plane: float = 0.01, name: str = "") -> Camera:
        """The camera of a viewmat [4, 4], world to camera, and a K [3, 3], pixels, without skew. The camera's centre is computed
        from viewmat in binary64. So a frame may differ in its last bits from one of the camera that viewmat was made of."""
        np = numpy()
        view, k = np.asarray(viewmat, np.float64), np.asarray(K, np.float64)
        if view.shape != (4, 4) or k.shape != (3, 3):
            raise ValueError(f"expected a viewmat [4, 4] and a K [3, 3], not {list(view.shape)} and {list(k.shape)}")
        if k[0, 1] or k[1, 0] or k[2].tolist() != [0, 0, 1] or view[3].tolist() != [0, 0, 0, 1]:
            raise ValueError("expected a K without skew, ending in 0 0 1, and a viewmat that ends in 0 0 0 1")
        rotation = view[:3, :3].T
        pose = np.concatenate([rotation, -rotation @ view[:3, 3:]], axis=1)
        return cls(int(width), int(height), float(k[0, 0]), float(k[1, 1]), float(k[0, 2]), float(k[1, 2]),
                   tuple(pose.ravel().tolist()), float(near_plane), name)

    @property
    def camtoworld(self) -> Float64:
        """float64 [4, 4], camera to world."""
        np = numpy()
        return np.array([*self.cam_to_world, 0, 0, 0, 1], np.float64).reshape(4, 4)

    @property
    def viewmat(self) -> Float64:
        """float64 [4, 4], world to camera, as gsplat takes it."""
        np = numpy()
        pose, view = self.camtoworld, np.eye(4)
        view[:3, :3] = pose[:3, :3].T
        view[:3, 3] = -view[:3, :3] @ pose[:3, 3]
        return view

    @property
    def K(self) -> Float64:
        """float64 [3, 3], pixels, as gsplat takes it."""
        return numpy().array([[self.fx, 0, self.cx], [0, self.fy, self.cy], [0, 0, 1]])


def to_struct(camera: Camera) -> s.adcgs_camera:
    pose = [float(value) for value in camera.cam_to_world]
    name = camera.name.encode()
    if len(pose) != 12 or len(name) > 63:
        raise ValueError("a camera's cam_to_world has 12 numbers, and its name at most 63 bytes")
    out = s.adcgs_camera(camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy)
    out.cam_to_world[:] = pose
    out.near_plane, out.name = camera.near_plane, name
    return out


def from_struct(camera: s.adcgs_camera, time: float | None = None, path: int | None = None) -> Camera:
    return Camera(camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy, tuple(camera.cam_to_world),
                  camera.near_plane, camera.name.decode("utf-8", "replace"), time, path)
