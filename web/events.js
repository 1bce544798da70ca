// SPDX-License-Identifier: BSD-2-Clause
// The player's events as the browser's: names of keys, kinds of events, steps of the wheel.
'use strict';

const KEYS = { Escape: 27, ArrowLeft: 256, ArrowRight: 257, Home: 258, End: 259, PageUp: 260, PageDown: 261, F1: 262,
               Shift: 263 };
const KEY = 2, BUTTON = 3, MOTION = 4, WHEEL = 5, LOST = 7; // src/play/event.h
const WHEEL_STEP = 100;                                     // pixels that browsers scroll per notch
const ZOOM_STEP = 0.9;                                      // src/camera/orbit_control.c
