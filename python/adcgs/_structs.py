# SPDX-License-Identifier: BSD-2-Clause
"""The structs of adcgs/types.h and adcgs/status.h. tests/python compares them with the headers and with C's own layout."""
from ctypes import (CFUNCTYPE, POINTER, Structure, c_char, c_char_p, c_double, c_float, c_int, c_int32, c_int64, c_size_t,
                    c_uint32, c_uint64, c_void_p)

CPU_LEVELS = ("auto", "scalar", "avx2", "avx512")
LOG_LEVELS = {1: "warning", 2: "info"}
ARRIVALS = ("nothing", "header", "cameras", "segment", "end")
ALPHAS = ("opaque", "straight", "premultiplied")

LOG_FN = CFUNCTYPE(None, c_void_p, c_int, c_char_p)
READ_FN = CFUNCTYPE(c_int64, c_void_p, c_void_p, c_size_t)
READ_AT_FN = CFUNCTYPE(c_int64, c_void_p, c_uint64, c_void_p, c_size_t)


class adcgs_error(Structure):
    _fields_ = [("status", c_int), ("text", c_char * 248)]


class adcgs_config(Structure):
    _fields_ = [("size", c_size_t), ("threads", c_int), ("cpu", c_int), ("layers", c_int), ("memory_limit", c_uint64),
                ("strict_end", c_int), ("pool", c_void_p), ("log", LOG_FN), ("log_user", c_void_p), ("conceal", c_int),
                ("on_demand", c_int), ("tune_in", c_int)]


class adcgs_bytes(Structure):
    _fields_ = [("header", c_uint64), ("networks", c_uint64), ("geometry", c_uint64), ("layer", c_uint64 * 5),
                ("cameras", c_uint64), ("metadata", c_uint64), ("total", c_uint64)]


class adcgs_info(Structure):
    _fields_ = [("size", c_size_t), ("version_major", c_int), ("version_minor", c_int), ("profile", c_int), ("level", c_int),
                ("segments", c_int), ("anchors", c_uint32), ("gaussians", c_uint32), ("static_anchors", c_uint32),
                ("weights", c_uint32), ("k", c_int), ("layers", c_int), ("cameras", c_int), ("time_start", c_double),
                ("time_end", c_double), ("frame_rate", c_double), ("scene_origin", c_double * 3), ("scene_scale", c_double),
                ("background", c_float * 3), ("truncated", c_int), ("colour", c_char * 32), ("axes", c_char * 32),
                ("units", c_char * 32), ("bytes", adcgs_bytes), ("metadata", c_int), ("faults", c_int), ("tiers", c_int),
                ("tiers_present", c_int), ("time_committed", c_double), ("time_available", c_double), ("segments_total", c_int),
                ("tiers_received", c_int), ("first_segment", c_int), ("screen_filter", c_float),
                ("bytes_max", c_uint64)]


class adcgs_camera(Structure):
    _fields_ = [("width", c_int32), ("height", c_int32), ("fx", c_double), ("fy", c_double), ("cx", c_double), ("cy", c_double),
                ("cam_to_world", c_double * 12), ("near_plane", c_double), ("name", c_char * 64)]


class adcgs_view(Structure):
    _fields_ = [("width", c_int32), ("height", c_int32), ("rotation", c_float * 9), ("translation", c_float * 3), ("fx", c_float),
                ("fy", c_float), ("cx", c_float), ("cy", c_float), ("near_plane", c_float), ("limit", c_float * 4)]


class adcgs_frame(Structure):
    _fields_ = [("width", c_int32), ("height", c_int32), ("rgb", c_void_p)]


class adcgs_primitives(Structure):
    _fields_ = [("n", c_uint32), ("mean", POINTER(c_float) * 3), ("scale", POINTER(c_float) * 3),
                ("rotation", POINTER(c_float) * 4), ("opacity", POINTER(c_float)), ("colour", POINTER(c_float) * 3)]


STRUCTS = (adcgs_error, adcgs_config, adcgs_bytes, adcgs_info, adcgs_camera, adcgs_view, adcgs_frame, adcgs_primitives)
