# SPDX-License-Identifier: BSD-2-Clause
"""The Python package gives the results of the programs. Run by test_python.sh in the build folder, with VECTORS and OUT set."""
import hashlib
import inspect
import io
import os
import pathlib
import re
import subprocess
import sys
import typing
import unittest

import numpy as np

import adcgs

vectors = pathlib.Path(os.environ["VECTORS"])
out = pathlib.Path(os.environ["OUT"])
STILL, MOVING, LONG = (str(vectors / f"good-{name}.adcgs") for name in ("sys-cams", "deform-bodies", "seq-segments"))


def dec(*arguments):
    return subprocess.run(["./adcgs-dec", *map(str, arguments)], check=True, capture_output=True, text=True).stdout.split()


def plain_camera(info, width=96, height=64):
    """A camera at some distance from the scene, for streams without cameras."""
    x, y, z = info.scene_origin
    pose = (1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z - 2.5 * info.scene_scale)
    return adcgs.Camera(width, height, 90.0, 95.0, 47.0, 33.0, pose, 0.01)


def ply(path):
    """Properties of a binary PLY of floats, by name."""
    data = path.read_bytes()
    head, body = data.split(b"end_header\n", 1)
    names = [line.split()[-1].decode() for line in head.split(b"\n") if line.startswith(b"property float")]
    rows = np.frombuffer(body, "<f4").reshape(-1, len(names))
    return {name: rows[:, i] for i, name in enumerate(names)}


class Streams(unittest.TestCase):
    def test_frames_are_the_programs(self):
        with adcgs.open(STILL) as stream:
            self.assertGreater(stream.info.cameras, 1)
            for camera in range(stream.info.cameras):
                ours = [adcgs.frame_digest(frame) for _, frame in stream.frames(camera)]
                self.assertGreater(len(ours), 1)
                self.assertEqual(ours, dec(STILL, "--md5", "--quiet", "--camera", camera))

    def test_digests_are_md5_of_the_array(self):
        with adcgs.open(STILL) as stream:
            frame = stream.render(stream.info.time_start)
        self.assertEqual((frame.dtype, frame.shape[2]), (np.float32, 3))
        self.assertEqual(hashlib.md5(frame.astype("<f4").tobytes()).hexdigest(), adcgs.frame_digest(frame))
        eight = adcgs.frame_to_u8(frame)
        self.assertTrue((eight == np.floor(np.clip(frame, 0, 1) * np.float32(255) + np.float32(0.5)).astype(np.uint8)).all())
        self.assertRaises(ValueError, adcgs.frame_digest, frame[0])

    def test_any_camera(self):
        """A camera that is not in the stream, compared with the program's answers to requests."""
        for path in (MOVING, LONG):
            with adcgs.open(path, threads=2) as stream:
                info = stream.info
                camera, times = plain_camera(info), stream.times()[::4]
                numbers = " ".join(map(repr, map(float, camera.cam_to_world)))
                request = out / "requests.txt"
                request.write_text(f"camera 96 64 90 95 47 33 0.01 {numbers}\n" + "".join(f"frame 0 {t!r}\n" for t in times) +
                                   "".join(f"splats {t!r}\n" for t in times) + "model\n")
                answers = subprocess.run(["./adcgs-dec", path, "--answer", str(request)], check=True, capture_output=True,
                                         text=True).stdout.splitlines()
                ours = [adcgs.frame_digest(frame) for _, frame in stream.frames(camera, times)]
                ours += [stream.splat_digest(t) for t in times] + [stream.model_digest(i) for i in range(info.segments)]
                self.assertEqual(ours, [line.split()[-1] for line in answers])

    def test_splats_are_the_programs(self):
        for path in (MOVING, LONG):
            with adcgs.open(path) as stream:
                time = stream.info.time_end
                splats = stream.splats(time)
                slots = stream.splats(time, units="scene", draws_nothing=True)
            dec(path, "--splats", out / "splats.ply", "--axes", "keep", "--time", repr(time), "--quiet")
            theirs = ply(out / "splats.ply")
            self.assertGreater(len(splats.means), 0)
            for i, name in enumerate("xyz"):
                self.assertTrue((splats.means[:, i] == theirs[name]).all())
            for i in range(4):
                self.assertTrue((splats.quats[:, i] == theirs[f"rot_{i}"]).all())
            for i in range(3):
                self.assertTrue(np.allclose(np.log(splats.scales[:, i]), theirs[f"scale_{i}"], atol=1e-6))
                self.assertTrue(np.allclose((splats.colors[:, i] - 0.5) / 0.28209479177387814, theirs[f"f_dc_{i}"], atol=1e-5))
            self.assertTrue(np.allclose(1 / (1 + np.exp(-theirs["opacity"].astype(float))), splats.opacities, atol=1e-6))
            self.assertEqual(len(slots.means) % 64, 0)
            self.assertEqual(int((slots.opacities > 0).sum()), len(splats.means))
            self.assertTrue(all(array.dtype == np.float32 for array in splats + slots))

    def test_gsplat_cameras(self):
        """viewmats and Ks give the frames of their cameras, except for rounding of the camera's position."""
        with adcgs.open(STILL) as stream:
            camera = stream.camera(0)
            self.assertTrue(np.allclose(camera.viewmat @ camera.camtoworld, np.eye(4), atol=1e-12))
            colors, alphas = stream.rasterize(0.0, [camera.viewmat] * 2, [camera.K] * 2, camera.width, camera.height,
                                              camera.near_plane)
            frame, (_, alpha) = stream.render(0.0, camera), stream.render_depth(0.0, camera)
            again = adcgs.Camera.from_gsplat(camera.viewmat, camera.K, camera.width, camera.height)
        self.assertEqual(colors.shape, (2, camera.height, camera.width, 3))
        self.assertEqual(alphas.shape, (2, camera.height, camera.width, 1))
        self.assertLess(np.abs(colors - frame).max(), 1e-3)
        self.assertLess(np.abs(alphas[0, :, :, 0] - alpha).max(), 1e-3)
        self.assertTrue(np.allclose(again.cam_to_world, camera.cam_to_world, atol=1e-12))
        self.assertRaises(ValueError, adcgs.Camera.from_gsplat, np.eye(3), np.eye(3), 8, 8)
        skewed = np.eye(3)
        skewed[0, 1] = 1
        self.assertRaises(ValueError, adcgs.Camera.from_gsplat, np.eye(4), skewed, 8, 8)

    def test_pictures(self):
        with adcgs.open(STILL, cpu="scalar", threads=1) as stream:
            frame, opaque = stream.render(0.0), stream.render_rgba8(0.0, alpha="opaque")
            straight = stream.render_rgba8(0.0)
            depth, alpha = stream.render_depth(0.0)
        self.assertTrue((opaque[:, :, :3] == adcgs.frame_to_u8(frame)).all() and (opaque[:, :, 3] == 255).all())
        self.assertTrue((straight[:, :, 3] == np.floor(alpha * np.float32(255) + np.float32(0.5))).all())
        self.assertTrue((depth[alpha == 0] == np.float32(1e10)).all())

    def test_info(self):
        import json
        theirs = json.loads(subprocess.run(["./adcgs-info", LONG, "--json"], check=True, capture_output=True, text=True).stdout)
        with adcgs.open(LONG) as stream:
            info = stream.info
            self.assertEqual(info.bytes.total, os.path.getsize(LONG))
            self.assertEqual(sum(info.bytes.layer) + info.bytes.header + info.bytes.networks + info.bytes.geometry +
                             info.bytes.cameras + info.bytes.metadata, info.bytes.total)
        self.assertGreater(info.segments, 1)
        self.assertIn(str(info.anchors), json.dumps(theirs))
        with adcgs.open(str(vectors / "good-sys-meta.adcgs")) as stream:
            self.assertEqual(len(stream.metadata) > 0, stream.info.metadata > 0)
        with adcgs.open(str(vectors / "good-sys-cams-names.adcgs")) as stream:
            for camera in stream.cameras:
                self.assertEqual(stream.camera(camera.name), next(c for c in stream.cameras if c.name == camera.name))
            self.assertRaises(KeyError, stream.camera, "no such camera")


class Sources(unittest.TestCase):
    def setUp(self):
        self.data = pathlib.Path(LONG).read_bytes()
        with adcgs.open(LONG) as stream:
            self.times = stream.times()
            self.expected = [stream.splat_digest(t) for t in self.times]

    def check(self, stream):
        self.assertEqual([stream.splat_digest(t) for t in self.times], self.expected)

    def test_bytes_objects_and_seeking(self):
        pool = adcgs.Pool(2)
        self.assertEqual(pool.threads, 2)
        for source in (self.data, bytearray(self.data), memoryview(self.data), io.BytesIO(self.data), pathlib.Path(LONG)):
            with adcgs.open(source, pool=pool) as stream:
                self.check(stream)
        for source in (LONG, io.BytesIO(self.data)):
            with adcgs.open(source, on_demand=True) as stream:
                self.check(stream)

    def test_push(self):
        """Any number of bytes at a time; available parts can be queried at once."""
        for step in (1, 97, len(self.data)):
            stream, brought, drawn = adcgs.open_push(), [], 0
            self.assertRaises(adcgs.UsageError, lambda: stream.info)
            for at in range(0, len(self.data), step):
                news = stream.push(self.data[at:at + step])
                brought += news
                if "segment" in news and not drawn:
                    drawn = len(stream.splats(self.times[0]).means)
            self.assertEqual((brought[0], brought[-1]), ("header", "end"))
            self.assertGreater(drawn, 0)
            stream.end()
            self.check(stream)
            stream.close()

    def test_prefix_and_forgetting(self):
        with adcgs.open_push() as stream:
            stream.push(self.data[:len(self.data) * 3 // 4])
            stream.end()
            self.assertTrue(stream.info.truncated)
        with adcgs.open_push() as stream:
            stream.push(self.data)
            stream.discard_before(self.times[-1])
            self.assertGreater(stream.info.first_segment, 0)
            self.assertEqual(stream.splat_digest(self.times[-1]), self.expected[-1])

    def test_what_a_source_raises(self):
        class Broken(io.RawIOBase):
            def read(self, size):
                raise ZeroDivisionError("broken")
        self.assertRaisesRegex(ZeroDivisionError, "broken", adcgs.open, Broken())
        self.assertRaises(TypeError, adcgs.open, 7)


class Failures(unittest.TestCase):
    def test_the_librarys_line(self):
        """The exception's text is the message of the program."""
        for name, kind in (("bad-geom-anchors-0", adcgs.DataError), ("no-such", adcgs.ReadError)):
            path = str(vectors / f"{name}.adcgs")
            printed = subprocess.run(["./adcgs-dec", path, "--md5"], capture_output=True, text=True).stderr
            with self.assertRaises(kind) as caught:
                adcgs.open(path)
            self.assertIn(str(caught.exception), printed)
            self.assertEqual(len(str(caught.exception).splitlines()), 1)

    def test_kinds(self):
        data = pathlib.Path(LONG).read_bytes()
        self.assertRaises(adcgs.TruncatedError, adcgs.open, data[:-20], strict=True)
        self.assertRaises(adcgs.LimitError, adcgs.open, data, memory_limit=1000)
        self.assertRaises(adcgs.DataError, adcgs.open, b"no stream at all, but some text")
        self.assertRaises(ValueError, adcgs.open, data, cpu="abacus")
        with adcgs.open(STILL) as stream:
            self.assertRaises(adcgs.UsageError, stream.camera, 1000)
            self.assertRaises(adcgs.UsageError, stream.model_digest, 1000)
            self.assertRaises(ValueError, stream.splats, 0, units="feet")
            self.assertRaises(ValueError, stream.render, 0, adcgs.Camera(0, 5, 1, 1, 0, 0, (0,) * 12))
        self.assertRaises(ValueError, lambda: stream.info)
        stream.close()

    def test_wrong_use(self):
        """One traceback, that of the call."""
        for call in ("adcgs.Decoder('f')", "adcgs.Pool(1, 2)", "adcgs.Pool('two')"):
            done = subprocess.run([sys.executable, "-c", f"import adcgs; {call}"], capture_output=True, text=True)
            self.assertEqual(done.returncode, 1)
            self.assertEqual(done.stderr.count("Traceback"), 1, done.stderr)
            self.assertNotIn("Exception ignored", done.stderr)

    def test_log(self):
        told = []
        damaged = bytearray(pathlib.Path(LONG).read_bytes())
        damaged[len(damaged) // 2] ^= 0xff
        with adcgs.open(bytes(damaged), conceal=True, log=lambda level, text: told.append((level, text))) as stream:
            self.assertGreater(stream.info.faults, 0)
        self.assertIn("warning", [level for level, _ in told])

    def test_without_numpy(self):
        """Without NumPy, calls that return arrays raise ImportError; the others work."""
        code = ("import sys; sys.modules['numpy'] = None\nimport adcgs\ns = adcgs.open(sys.argv[1])\n"
                "print(s.info.cameras, s.cameras[0].fx, s.splat_digest(0.0))\n"
                "try:\n    s.render(0.0)\nexcept ImportError as e:\n    print(e)")
        done = subprocess.run([sys.executable, "-c", code, STILL], check=True, capture_output=True, text=True)
        lines = done.stdout.splitlines()
        self.assertTrue(re.match(r"\d+ [\d.]+ [0-9a-f]{32}$", lines[0]))
        self.assertIn("NumPy", lines[1])


class Names(unittest.TestCase):
    def test_repr(self):
        with adcgs.open(LONG) as stream:
            self.assertRegex(repr(stream), r"^<adcgs.Decoder: 0 to 0.12 s, .* frames/s, 3 segments, [\d,]+ primitives, .*bytes>$")
            self.assertRegex(repr(stream.splats(0)), r"^<adcgs.Splats: [\d,]+ splats?>$")
        self.assertEqual(repr(stream), "<adcgs.Decoder: closed>")
        self.assertEqual(repr(adcgs.open_push()), "<adcgs.PushDecoder: no header yet>")
        self.assertEqual(repr(adcgs.Pool(1)), "<adcgs.Pool: 1 thread>")

    def test_hints(self):
        """Every public function and method has types for all that it takes and returns; the class of a result is that type."""
        functions = [value for name, value in vars(adcgs).items() if name in adcgs.__all__ and inspect.isfunction(value)]
        for kind in (adcgs.Camera, adcgs.Decoder, adcgs.PushDecoder, adcgs.Pool):
            for member in vars(kind).values():
                member = getattr(member, "fget", None) or getattr(member, "__func__", member)
                if inspect.isfunction(member) and not member.__name__.startswith("__"):
                    functions.append(member)
        self.assertGreater(len(functions), 25)
        for function in functions:
            hints = typing.get_type_hints(function)
            names = [name for name in inspect.signature(function).parameters if name not in ("self", "cls")]
            self.assertEqual(sorted(hints), sorted([*names, "return"]), function.__qualname__)
        with adcgs.open(LONG) as stream:
            for result in (stream.info, stream.info.bytes):
                for name, hint in typing.get_type_hints(type(result)).items():
                    self.assertIsInstance(getattr(result, name), typing.get_origin(hint) or hint, name)


@unittest.skipUnless(os.access("adcgs-enc", os.X_OK) and os.access("adcgs-demo-scene", os.X_OK), "no encoder")
class Encoding(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(os.environ["OUT"], "encoding")
        cls.folder.mkdir()
        cls.scene = cls.folder / "scene"
        subprocess.run(["./adcgs-demo-scene", "--scene", "tiny", "--format", "ppm", "-q", "-o", cls.scene], check=True)

    def encode(self, name="s.adcgs", **options):
        return adcgs.encode(self.scene, self.folder / name, program="./adcgs-enc", preset="draft", threads=1, **options)

    def test_report_and_progress(self):
        lines = []
        report = self.encode(iterations=40, set={"matching_frames": 0, "n_fg": 0}, fixed=True, bf16=False, progress=lines.append)
        self.assertEqual((lines[0]["iteration"], lines[-1]["iteration"], lines[-1]["stage"]), (0, 40, "decisions"))
        with adcgs.open(self.folder / "s.adcgs") as stream:
            self.assertEqual(stream.info.bytes.total, report["bytes"])

    def test_an_exception_ends_it(self):
        """The state is kept, and the exception of the callback is raised."""
        def stop(line):
            if line["iteration"]:
                raise ZeroDivisionError(line["stage"])
        self.assertRaises(ZeroDivisionError, self.encode, "stopped.adcgs", iterations=2000, progress=stop)
        self.assertTrue((self.folder / "stopped.adcgs.checkpoint").exists())
        self.assertFalse((self.folder / "stopped.adcgs").exists())

    def test_failures(self):
        for options, kind, text in (({"iterations": 3}, adcgs.UsageError, "--iterations 3: expected"),
                                    ({"no_such": 1}, adcgs.UsageError, "--no-such"), ({"log": "x"}, adcgs.UsageError, "log")):
            self.assertRaisesRegex(kind, text, self.encode, **options)
        self.assertRaisesRegex(adcgs.ReadError, "no-scene", adcgs.encode, "no-scene", "x", program="./adcgs-enc")
        self.assertRaisesRegex(adcgs.UnsupportedError, "no-program: not found", adcgs.encode, self.scene, "x", program="no-program")


if __name__ == "__main__":
    unittest.main()
