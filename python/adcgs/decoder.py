# SPDX-License-Identifier: BSD-2-Clause
"""Decoders: open a stream, query its contents, get its splats, render frames."""
from __future__ import annotations

import ctypes
import math
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, BinaryIO, Literal, NamedTuple, TypeVar

from . import _structs as s
from ._library import call, digest, lib
from ._numpy import Float32, Uint8, numpy
from ._source import open_source
from .camera import Camera, from_struct, to_struct
from .errors import Error

Cpu = Literal["auto", "scalar", "avx2", "avx512"]
Alpha = Literal["opaque", "straight", "premultiplied"]
Arrival = Literal["header", "cameras", "segment", "end"]
Log = Callable[[str, str], Any]
_Self = TypeVar("_Self", bound="Decoder")


class Splats(NamedTuple):
    """Splats at one time, float32, with gsplat's names: input of gsplat.rasterization() with sh_degree None.

    means      [N, 3]  centres
    quats      [N, 4]  unit quaternions w x y z, from a splat's axes to the world's
    scales     [N, 3]  standard deviations along a splat's axes, above 0 (not their logarithms)
    opacities  [N]     0 to 0.99 (not logits)
    colors     [N, 3]  RGB in the stream's transfer characteristic (Info.colour), 0 black to 1 white, not clipped
    """

    means: Float32
    quats: Float32
    scales: Float32
    opacities: Float32
    colors: Float32

    def __repr__(self) -> str:
        return f"<adcgs.Splats: {_count(len(self.means), 'splat')}>"


class Bytes(NamedTuple):
    """Bytes of a stream by content: the members of adcgs_bytes."""

    header: int
    networks: int
    geometry: int
    layer: tuple[int, ...]
    cameras: int
    metadata: int
    total: int


class Info(NamedTuple):
    """Summary of a stream: the members of adcgs_info (adcgs_get_info(3)). Times are in seconds, scene_origin in world units;
    world = scene_origin + scene_scale * scene."""

    version_major: int
    version_minor: int
    profile: int
    level: int
    segments: int
    anchors: int
    gaussians: int
    static_anchors: int
    weights: int
    k: int
    layers: int
    cameras: int
    time_start: float
    time_end: float
    frame_rate: float
    scene_origin: tuple[float, float, float]
    scene_scale: float
    background: tuple[float, float, float]
    truncated: int
    colour: str
    axes: str
    units: str
    bytes: Bytes
    metadata: int
    faults: int
    tiers: int
    tiers_present: int
    time_committed: float
    time_available: float
    segments_total: int
    tiers_received: int
    first_segment: int
    screen_filter: float
    bytes_max: int


def _count(n: int, word: str) -> str:
    return f"{n:,} {word}{'' if n == 1 else 's'}"


class Pool:
    """Threads that several decoders share. threads: 1 to 256, including the calling one; 0: one for each processor."""

    _handle = ctypes.c_void_p()  # if the constructor fails

    def __init__(self, threads: int = 0) -> None:
        self._handle = ctypes.c_void_p()
        call(lib.adcgs_pool_create, ctypes.byref(self._handle), threads)

    def __repr__(self) -> str:
        return f"<adcgs.Pool: {_count(self.threads, 'thread')}>"

    def __del__(self) -> None:
        if self._handle:
            lib.adcgs_pool_free(ctypes.byref(self._handle))

    @property
    def threads(self) -> int:
        """Number of threads."""
        return lib.adcgs_pool_threads(self._handle)


def _plain(value: Any) -> Any:
    """A struct's member as a Python value."""
    if isinstance(value, s.adcgs_bytes):
        return Bytes(*(_plain(getattr(value, name)) for name in Bytes._fields))
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    return tuple(value) if isinstance(value, ctypes.Array) else value


def _make_config(threads: int, cpu: str, layers: int, memory_limit: int, strict: bool, conceal: bool, on_demand: bool,
                 tune_in: bool, pool: Pool | None, log: Log | None) -> s.adcgs_config:
    config = s.adcgs_config()
    lib.adcgs_config_init(ctypes.byref(config), ctypes.sizeof(config))
    if cpu not in s.CPU_LEVELS:
        raise ValueError(f"cpu: {cpu}: expected one of {', '.join(s.CPU_LEVELS)}")
    config.threads, config.cpu, config.layers, config.memory_limit = threads, s.CPU_LEVELS.index(cpu), layers, memory_limit
    config.strict_end, config.conceal, config.on_demand, config.tune_in = strict, conceal, on_demand, tune_in
    if pool is not None:
        config.pool = pool._handle
    if log is not None:
        tell = log
        config.log = s.LOG_FN(lambda _, level, text: tell(s.LOG_LEVELS.get(level, "info"), text.decode("utf-8", "replace")))
    return config


class Decoder:
    """An open stream, made by open(). Only one thread at a time may use it; different decoders are independent. It is closed at
    the end of a with statement, by close(), or with its last reference. A failure raises an Error with the library's one-line
    message."""

    _handle = ctypes.c_void_p()  # if the constructor fails

    def __init__(self, config: s.adcgs_config, pool: Pool | None) -> None:
        self._handle = ctypes.c_void_p()
        self._source: Any = None
        self._config, self._pool = config, pool  # keep alive: the library uses both

    def __repr__(self) -> str:
        name = f"adcgs.{type(self).__name__}"
        if not self._handle:
            return f"<{name}: closed>"
        try:
            info = self.info
        except Error:
            return f"<{name}: no header yet>"
        return (f"<{name}: {info.time_start:g} to {info.time_end:g} s, {info.frame_rate:g} frames/s, "
                f"{_count(info.segments, 'segment')}, {_count(info.gaussians, 'primitive')}, {_count(info.cameras, 'camera')}, "
                f"{_count(info.bytes.total, 'byte')}>")

    def __enter__(self: _Self) -> _Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        self.close()

    def close(self) -> None:
        """Free everything that it owns. Arrays that it returned stay valid."""
        if self._handle:
            lib.adcgs_close(ctypes.byref(self._handle))
        self._source = None

    def _call(self, function: Any, *arguments: Any) -> None:
        if not self._handle:
            raise ValueError("the decoder is closed")
        (self._source.call if self._source else call)(function, self._handle, *arguments)

    # ---- contents of the stream ----

    @property
    def info(self) -> Info:
        """An Info with the current values."""
        info = s.adcgs_info()
        self._call(lib.adcgs_get_info, ctypes.byref(info), ctypes.sizeof(info))
        return Info(*(_plain(getattr(info, name)) for name in Info._fields))

    @property
    def cameras(self) -> list[Camera]:
        """The stored cameras, a list of Camera."""
        return [self.camera(i) for i in range(self.info.cameras)]

    def camera(self, which: int | str | Camera) -> Camera:
        """A stored camera, by its number or its name; a Camera is returned unchanged."""
        if isinstance(which, Camera):
            return which
        if isinstance(which, str):
            for camera in self.cameras:
                if camera.name == which:
                    return camera
            raise KeyError(f"{which}: no stored camera has that name")
        view = s.adcgs_camera()
        time, path = ctypes.c_double(), ctypes.c_int()
        self._call(lib.adcgs_get_camera, which, ctypes.byref(view))
        self._call(lib.adcgs_get_camera_time, which, ctypes.byref(time), ctypes.byref(path))
        return from_struct(view, None if math.isnan(time.value) else time.value, path.value if path.value >= 0 else None)

    @property
    def metadata(self) -> dict[str, str]:
        """Texts stored in the stream, a dict; of a repeated key, the first text. Their contents are untrusted."""
        texts: dict[str, str] = {}
        for i in range(self.info.metadata):
            key = lib.adcgs_get_metadata_key(self._handle, i)
            texts[_plain(key)] = _plain(lib.adcgs_get_metadata(self._handle, key))
        return texts

    def times(self, begin: float | None = None, end: float | None = None) -> list[float]:
        """Times from begin to end, in seconds, both included, at the stream's frame rate; by default the whole stream."""
        info = self.info
        begin = info.time_start if begin is None else begin
        end = info.time_end if end is None else end
        return [begin + i / info.frame_rate for i in range(math.floor((end - begin) * info.frame_rate + 1.0 + 1e-6))]

    # ---- splats ----

    def set_tiers(self, tiers: int) -> None:
        """From now on, render only the first tiers, a coarser image in less time; 0: all."""
        self._call(lib.adcgs_set_tiers, tiers)

    def splats(self, time: float, units: Literal["world", "scene"] = "world", draws_nothing: bool = False) -> Splats:
        """Splats at a time in seconds; a time outside the stream's range becomes its start or end.

        units          "world", or "scene": the numbers that the decoder computes, without the scene's origin and scale
        draws_nothing  True: all slots of the stream, including those of opacity 0, so that a slot is the same splat at all times
        """
        np = numpy()
        primitives, info = s.adcgs_primitives(), self.info
        if units not in ("world", "scene"):
            raise ValueError(f"units: {units}: expected world or scene")
        self._call(lib.adcgs_get_primitives, time, ctypes.byref(primitives))

        def take(*arrays: Any) -> Any:
            return np.stack([np.ctypeslib.as_array(array, (primitives.n,)) for array in arrays], axis=-1)

        means, scales = take(*primitives.mean), take(*primitives.scale)
        with np.errstate(over="ignore", under="ignore"):
            if units == "world":
                means = (np.array(info.scene_origin) + info.scene_scale * means.astype(np.float64)).astype(np.float32)
                scales = (info.scene_scale * scales.astype(np.float64)).astype(np.float32)
        out = Splats(means, take(*primitives.rotation), scales, take(primitives.opacity)[:, 0], take(*primitives.colour))
        if draws_nothing:
            return out
        kept = (out.opacities > 0) & np.isfinite(means).all(1) & np.isfinite(scales).all(1)
        kept &= (scales >= np.finfo(np.float32).tiny).all(1)
        return Splats(*(array[kept] for array in out))

    # ---- frames ----

    def render(self, time: float, camera: int | str | Camera = 0) -> Float32:
        """A frame, float32 [height, width, 3]: RGB in the stream's transfer characteristic, 0 black to 1 white, not clipped. It
        is the same to the last bit on every machine. camera: a Camera, or a stored one's number or name."""
        view = to_struct(self.camera(camera))
        out: Any = self._array(view, 3)
        frame = s.adcgs_frame(view.width, view.height, out.ctypes.data)
        self._call(lib.adcgs_render, ctypes.byref(view), time, ctypes.byref(frame))
        return out

    def render_rgba8(self, time: float, camera: int | str | Camera = 0, alpha: Alpha = "straight") -> Uint8:
        """An image, uint8 [height, width, 4]. alpha: "straight" or "premultiplied": A is the coverage of the splats, without
        background; "opaque": the frame, and A is 255."""
        if alpha not in s.ALPHAS:
            raise ValueError(f"alpha: {alpha}: expected one of {', '.join(s.ALPHAS)}")
        view = to_struct(self.camera(camera))
        out: Any = self._array(view, 4, "uint8")
        self._call(lib.adcgs_render_rgba8, ctypes.byref(view), time, s.ALPHAS.index(alpha), out.ctypes.data, 4 * view.width)
        return out

    def render_depth(self, time: float, camera: int | str | Camera = 0) -> tuple[Float32, Float32]:
        """(depth, alpha), float32 [height, width] each. depth: world units along the camera's axis, 1e10 where alpha is 0. alpha:
        the coverage of the splats, 0 to 1."""
        view = to_struct(self.camera(camera))
        depth, alpha = self._array(view), self._array(view)
        self._call(lib.adcgs_render_depth, ctypes.byref(view), time, depth.ctypes.data, alpha.ctypes.data)
        return depth, alpha

    def rasterize(self, time: float, viewmats: Sequence[Any], Ks: Sequence[Any], width: int, height: int,
                  near_plane: float = 0.01) -> tuple[Float32, Float32]:
        """Frames as gsplat.rasterization() returns them: (colors [C, height, width, 3], alphas [C, height, width, 1]), float32,
        with the stream's background behind the splats. viewmats [C, 4, 4]: world to camera; Ks [C, 3, 3]: pixels."""
        np = numpy()
        cameras = [Camera.from_gsplat(viewmat, K, width, height, near_plane) for viewmat, K in zip(viewmats, Ks, strict=True)]
        colors = np.empty((len(cameras), height, width, 3), np.float32)
        alphas = np.empty((len(cameras), height, width, 1), np.float32)
        for i, camera in enumerate(cameras):
            colors[i] = self.render(time, camera)
            alphas[i, :, :, 0] = self.render_depth(time, camera)[1]
        return colors, alphas

    def frames(self, camera: int | str | Camera = 0, times: Iterable[float] | None = None) -> Iterator[tuple[float, Float32]]:
        """Yield (time, frame), as render() returns it, for each of times, in seconds; by default for times()."""
        camera = self.camera(camera)
        for time in self.times() if times is None else times:
            yield time, self.render(time, camera)

    def _array(self, camera: s.adcgs_camera, samples: int | None = None, kind: str = "float32") -> Any:
        if not 1 <= camera.width <= 16384 or not 1 <= camera.height <= 16384:
            raise ValueError(f"a camera of {camera.width}x{camera.height} pixels: expected 1 to 16384 each")
        return numpy().empty((camera.height, camera.width) + ((samples,) if samples else ()), kind)

    # ---- conformance ----

    def model_digest(self, segment: int) -> str:
        """MD5 of a segment's decoded model (point M), 32 hexadecimal digits."""
        out = digest()
        self._call(lib.adcgs_get_model_digest, segment, out)
        return bytes(out).hex()

    def splat_digest(self, time: float) -> str:
        """MD5 of the splats at a time (point S), 32 hexadecimal digits."""
        out = digest()
        self._call(lib.adcgs_get_splat_digest, time, out)
        return bytes(out).hex()


class PushDecoder(Decoder):
    """A decoder for bytes that arrive over time, made by open_push(). Before the first "header" queries fail, before the first
    "segment" rendering fails. From then on, the parts received so far serve all times."""

    def push(self, data: bytes | bytearray | memoryview) -> list[Arrival]:
        """Give the next bytes of the stream, any number of them. Returns the parts that they completed, a list of "header",
        "cameras", "segment" (one that can be rendered, or a further part of one) and "end". A failure is final, but the parts
        that arrived before it can still be rendered."""
        data, at = bytes(data), 0
        brought: list[Any] = []
        used, arrived = ctypes.c_size_t(), ctypes.c_int()
        start = ctypes.cast(ctypes.c_char_p(data), ctypes.c_void_p).value or 0
        while at < len(data) and brought[-1:] != ["end"]:
            self._call(lib.adcgs_push, start + at, len(data) - at, ctypes.byref(used), ctypes.byref(arrived))
            at += used.value
            if arrived.value:
                brought.append(s.ARRIVALS[arrived.value])
        return brought

    def end(self) -> None:
        """Declare that no more bytes will come. If the stream has not ended, its complete part remains."""
        self._call(lib.adcgs_push_end)

    def discard_before(self, time: float) -> None:
        """Declare that no time before this one, in seconds, will be requested again: past segments are freed."""
        self._call(lib.adcgs_push_discard_before, time)


def open(source: str | os.PathLike[str] | bytes | bytearray | memoryview | BinaryIO, *, threads: int = 0, cpu: Cpu = "auto",
         layers: int = 0, tiers: int = 0, memory_limit: int = 0, strict: bool = False, conceal: bool = False,
         on_demand: bool = False, tune_in: bool = False, pool: Pool | None = None, log: Log | None = None) -> Decoder:
    """Open a stream: a file's name, bytes, or an object with read(), which is read to the stream's end. Returns a Decoder.

    threads       1 to 256; 0: one for each processor
    cpu           "auto", "scalar", "avx2", "avx512": variant of the kernels; results never depend on it
    layers        use at most this many, 1 to 5; 0: all
    tiers         render only the first tiers, 1 to 8; 0: all
    memory_limit  bytes that the decoder may allocate; 0: bounded by the stream's level
    strict        refuse a stream that ends early; by default its complete part can be shown
    conceal       use the intact parts of a damaged stream, and report the damage to log
    on_demand     read a segment when a time in it is requested; an object with read() then needs seek()
    tune_in       the beginning may be missing, for an object with read()
    pool          a Pool to use instead of threads of its own
    log           log(level, text) receives messages; level is "warning" or "info"
    """
    config = _make_config(threads, cpu, layers, memory_limit, strict, conceal, on_demand, tune_in, pool, log)
    decoder = Decoder(config, pool)
    decoder._source = open_source(decoder._handle, source, config)
    if tiers:
        decoder.set_tiers(tiers)
    return decoder


def open_push(*, threads: int = 0, cpu: Cpu = "auto", layers: int = 0, memory_limit: int = 0, strict: bool = False,
              tune_in: bool = False, pool: Pool | None = None, log: Log | None = None) -> PushDecoder:
    """Open a PushDecoder; the arguments are those of open()."""
    decoder = PushDecoder(_make_config(threads, cpu, layers, memory_limit, strict, False, False, tune_in, pool, log), pool)
    call(lib.adcgs_open_push, ctypes.byref(decoder._handle), ctypes.byref(decoder._config))
    return decoder
