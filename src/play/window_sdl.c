/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The window, with SDL. */
#include "config.h"

#include "play/window.h"

#include "play/canvas_sdl.h"

#include <SDL.h>

#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define SMALLEST 64      /* pixels, minimum width or height */
#define USUAL_DPI 96.0   /* dots per inch of a screen with a density of 1: usual on desktops, by definition */
#define DENSITY_MIN 1.25 /* of screens: smaller differences from the usual one are none */
#define DENSITY_MAX 3.0  /* screens that report more do not know their size */

struct adcgs_window {
    SDL_Window *window;
    SDL_Renderer *renderer;
    SDL_Texture *picture;
    int picture_size[2];
    adcgs_sdl_canvas canvas;
    Uint32 wake_event;
};

/* Keys with another number in SDL; ASCII keys have the same. */
static const struct {
    int key;
    SDL_Keycode code;
} keys[] = {
    {ADCGS_KEY_LEFT, SDLK_LEFT},
    {ADCGS_KEY_RIGHT, SDLK_RIGHT},
    {ADCGS_KEY_HOME, SDLK_HOME},
    {ADCGS_KEY_END, SDLK_END},
    {ADCGS_KEY_PAGE_UP, SDLK_PAGEUP},
    {ADCGS_KEY_PAGE_DOWN, SDLK_PAGEDOWN},
    {ADCGS_KEY_F1, SDLK_F1},
    {ADCGS_KEY_F11, SDLK_F11},
    {ADCGS_KEY_SHIFT, SDLK_LSHIFT},
    {ADCGS_KEY_SHIFT, SDLK_RSHIFT},
    {'+', SDLK_KP_PLUS},
    {'-', SDLK_KP_MINUS},
};

static int key_of(SDL_Keycode code)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(keys); i++)
        if (keys[i].code == code)
            return keys[i].key;
    return code > 0 && code < 127 ? (int)code : 0;
}

static SDL_Keycode code_of(int key)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(keys) && key > 127; i++)
        if (keys[i].key == key)
            return keys[i].code;
    return key;
}

/** Reduces the size to the screen's room, with the same aspect ratio. */
static void fit_screen(int *width, int *height)
{
    SDL_Rect usable;
    if (SDL_GetDisplayUsableBounds(0, &usable) || usable.w < SMALLEST || usable.h < SMALLEST)
        return;
    const double x = (double)usable.w / *width, y = (double)usable.h / *height, scale = ADCGS_MIN(x, y);
    if (scale >= 1.0)
        return;
    *width = ADCGS_MAX(SMALLEST, (int)(*width * scale));
    *height = ADCGS_MAX(SMALLEST, (int)(*height * scale));
}

static void window_close(adcgs_window **window)
{
    adcgs_window *w = *window;
    *window = NULL;
    if (!w)
        return;
    adcgs_sdl_canvas_clear(&w->canvas);
    if (w->picture)
        SDL_DestroyTexture(w->picture);
    if (w->renderer)
        SDL_DestroyRenderer(w->renderer);
    if (w->window)
        SDL_DestroyWindow(w->window);
    SDL_Quit();
    free(w);
}

/** True if a driver of SDL has a visible display, and can be asked without printing messages of its own. */
static int has_display(const char *driver)
{
    static const char *const blind[] = {"dummy", "evdev", "offscreen"};
    for (size_t i = 0; i < ADCGS_COUNTOF(blind); i++)
        if (!strcmp(driver, blind[i]))
            return 0;
    return strcmp(driver, "wayland") || SDL_getenv("XDG_RUNTIME_DIR") || SDL_getenv("WAYLAND_SOCKET");
}

/** Initialises the driver that the user names, or the first with a display: SDL itself also accepts one without a display. */
static int init_video(void)
{
    const char *const named = SDL_getenv("SDL_VIDEODRIVER");
    if (named && *named)
        return SDL_Init(SDL_INIT_VIDEO);
    for (int i = 0; i < SDL_GetNumVideoDrivers(); i++) {
        const char *const driver = SDL_GetVideoDriver(i);
        if (has_display(driver) && !SDL_setenv("SDL_VIDEODRIVER", driver, 1) && !SDL_Init(SDL_INIT_VIDEO))
            return 0;
    }
    return SDL_SetError("none of SDL's drivers finds a display");
}

static adcgs_status open_parts(adcgs_window *w, const char *title, int width, int height, adcgs_error *error)
{
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1"); /* the program has its own */
    SDL_SetHint(SDL_HINT_RENDER_SCALE_QUALITY, "linear");
    if (init_video())
        return adcgs_fail(error, ADCGS_ERR_IO, "%.100s: no display to play on: %s", title, SDL_GetError());
    fit_screen(&width, &height);
    w->window = SDL_CreateWindow(title, SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, width, height,
                                 SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI);
    if (!w->window)
        return adcgs_fail(error, ADCGS_ERR_IO, "%.100s: cannot open a window: %s", title, SDL_GetError());
    w->renderer = SDL_CreateRenderer(w->window, -1, SDL_RENDERER_PRESENTVSYNC);
    if (!w->renderer)
        w->renderer = SDL_CreateRenderer(w->window, -1, SDL_RENDERER_SOFTWARE);
    if (!w->renderer)
        return adcgs_fail(error, ADCGS_ERR_IO, "%.100s: cannot render in a window: %s", title, SDL_GetError());
    adcgs_sdl_canvas_init(&w->canvas, w->renderer);
    SDL_SetWindowMinimumSize(w->window, SMALLEST, SMALLEST);
    w->wake_event = SDL_RegisterEvents(1);
    return ADCGS_OK;
}

static adcgs_status window_open(adcgs_window **out, const char *title, int width, int height, adcgs_error *error)
{
    *out = calloc(1, sizeof **out);
    if (!*out)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%.100s: out of memory for a window", title);
    const adcgs_status status = open_parts(*out, title, width, height, error);
    if (status != ADCGS_OK)
        window_close(out);
    return status;
}

static double measure(const adcgs_window *w, int *width, int *height)
{
    int points = 0, unused;
    SDL_GetWindowSize(w->window, &points, &unused);
    if (SDL_GetRendererOutputSize(w->renderer, width, height))
        SDL_GetWindowSize(w->window, width, height);
    *width = ADCGS_MAX(1, *width);
    *height = ADCGS_MAX(1, *height);
    return points > 0 ? (double)*width / points : 1.0;
}

/** Pixels per desktop unit, which is the unit of mouse positions. */
static double density_of(const adcgs_window *w)
{
    int width, height;
    return measure(w, &width, &height);
}

static void window_size(const adcgs_window *w, int *width, int *height, double *density)
{
    float dots = 0.0f, across, down;
    *density = measure(w, width, height);
    if (*density > 1.0 || SDL_GetDisplayDPI(SDL_GetWindowDisplayIndex(w->window), &dots, &across, &down))
        return;
    const double screen = ADCGS_MIN(dots / USUAL_DPI, DENSITY_MAX);
    if (screen >= DENSITY_MIN)
        *density = screen;
}

static void window_resize(adcgs_window *w, int width, int height)
{
    const double density = density_of(w);
    SDL_SetWindowSize(w->window, (int)(width / density + 0.5), (int)(height / density + 0.5));
}

static void translate_window(const SDL_WindowEvent *from, adcgs_event *out)
{
    switch (from->event) {
    case SDL_WINDOWEVENT_EXPOSED:
    case SDL_WINDOWEVENT_SIZE_CHANGED:
        out->kind = ADCGS_EVENT_SIZE;
        break;
    case SDL_WINDOWEVENT_FOCUS_LOST:
        out->kind = ADCGS_EVENT_LOST;
        break;
    case SDL_WINDOWEVENT_LEAVE:
        out->kind = ADCGS_EVENT_LEAVE;
        break;
    }
}

/** Mouse positions are in desktop units. */
static void translate_mouse(const SDL_Event *from, double density, adcgs_event *out)
{
    switch (from->type) {
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
        *out = (adcgs_event){.kind = ADCGS_EVENT_BUTTON,
                             .down = from->type == SDL_MOUSEBUTTONDOWN,
                             .button = from->button.button,
                             .clicks = from->button.clicks,
                             .x = density * from->button.x,
                             .y = density * from->button.y};
        break;
    case SDL_MOUSEMOTION:
        *out = (adcgs_event){.kind = ADCGS_EVENT_MOTION,
                             .x = density * from->motion.x,
                             .y = density * from->motion.y,
                             .dx = density * from->motion.xrel,
                             .dy = density * from->motion.yrel};
        break;
    case SDL_MOUSEWHEEL:
        *out = (adcgs_event){.kind = ADCGS_EVENT_WHEEL,
                             .dy = from->wheel.direction == SDL_MOUSEWHEEL_FLIPPED ? -from->wheel.y : from->wheel.y};
        break;
    }
}

static int window_event(adcgs_window *w, int milliseconds, adcgs_event *out)
{
    SDL_Event from;
    *out = (adcgs_event){.kind = ADCGS_EVENT_NONE};
    if (!(milliseconds > 0 ? SDL_WaitEventTimeout(&from, milliseconds) : SDL_PollEvent(&from)))
        return 0;
    switch (from.type) {
    case SDL_QUIT:
        out->kind = ADCGS_EVENT_QUIT;
        break;
    case SDL_WINDOWEVENT:
        translate_window(&from.window, out);
        break;
    case SDL_RENDER_TARGETS_RESET:
    case SDL_RENDER_DEVICE_RESET:
        adcgs_sdl_canvas_forget(&w->canvas);
        out->kind = ADCGS_EVENT_SIZE;
        break;
    case SDL_KEYDOWN:
    case SDL_KEYUP:
        *out = (adcgs_event){.kind = ADCGS_EVENT_KEY,
                             .key = key_of(from.key.keysym.sym),
                             .down = from.type == SDL_KEYDOWN,
                             .again = from.key.repeat};
        break;
    default:
        translate_mouse(&from, density_of(w), out);
    }
    return 1;
}

static void window_push(adcgs_window *w, const adcgs_event *event)
{
    const double density = density_of(w);
    const Sint32 x = (Sint32)(event->x / density), y = (Sint32)(event->y / density);
    SDL_Event to = {0};
    switch (event->kind) {
    case ADCGS_EVENT_KEY:
        to.key = (SDL_KeyboardEvent){.type = event->down ? SDL_KEYDOWN : SDL_KEYUP, .keysym = {.sym = code_of(event->key)}};
        break;
    case ADCGS_EVENT_BUTTON:
        to.button = (SDL_MouseButtonEvent){.type = event->down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP,
                                           .button = (Uint8)event->button,
                                           .clicks = (Uint8)event->clicks,
                                           .x = x,
                                           .y = y};
        break;
    case ADCGS_EVENT_MOTION:
        to.motion = (SDL_MouseMotionEvent){.type = SDL_MOUSEMOTION,
                                           .x = x,
                                           .y = y,
                                           .xrel = (Sint32)(event->dx / density),
                                           .yrel = (Sint32)(event->dy / density)};
        break;
    case ADCGS_EVENT_WHEEL:
        to.wheel = (SDL_MouseWheelEvent){.type = SDL_MOUSEWHEEL, .y = (Sint32)event->dy};
        break;
    default:
        return;
    }
    SDL_PushEvent(&to);
}

static void window_wake(adcgs_window *w)
{
    SDL_Event event = {.type = w->wake_event};
    SDL_PushEvent(&event);
}

static void window_fullscreen(adcgs_window *w, int on)
{
    SDL_SetWindowFullscreen(w->window, on ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0);
}

static void window_capture(adcgs_window *w, int on)
{
    SDL_SetRelativeMouseMode(on ? SDL_TRUE : SDL_FALSE);
}

/** Provides a texture of this size, kept while the size stays. \return 0 on failure */
static int need_texture(adcgs_window *w, SDL_Texture **texture, Uint32 format, int size[2], int width, int height)
{
    if (*texture && size[0] == width && size[1] == height)
        return 1;
    if (*texture)
        SDL_DestroyTexture(*texture);
    *texture = SDL_CreateTexture(w->renderer, format, SDL_TEXTUREACCESS_STREAMING, width, height);
    size[0] = width;
    size[1] = height;
    return *texture != NULL;
}

static adcgs_status window_picture(adcgs_window *w, const uint8_t *rgb, int width, int height, adcgs_error *error)
{
    if (!need_texture(w, &w->picture, SDL_PIXELFORMAT_RGB24, w->picture_size, width, height) ||
        SDL_UpdateTexture(w->picture, NULL, rgb, 3 * width))
        return adcgs_fail(error, ADCGS_ERR_IO, "cannot show an image of %dx%d: %s", width, height, SDL_GetError());
    return ADCGS_OK;
}

static const adcgs_type *window_type(const adcgs_window *w)
{
    return &w->canvas.type;
}

static const char *window_plain(const adcgs_window *w)
{
    return w->canvas.plain;
}

static adcgs_status window_show(adcgs_window *w, const adcgs_drawing *drawing, uint8_t *rgb, adcgs_error *error)
{
    int width, height;
    measure(w, &width, &height);
    int good = !SDL_SetRenderDrawColor(w->renderer, 0, 0, 0, 255) && !SDL_RenderClear(w->renderer);
    if (good && w->picture)
        good = !SDL_RenderCopy(w->renderer, w->picture, NULL, NULL);
    good = good && adcgs_sdl_canvas_draw(&w->canvas, drawing);
    if (good && rgb) /* before they are shown, since their contents are undefined afterwards */
        good = !SDL_RenderReadPixels(w->renderer, NULL, SDL_PIXELFORMAT_RGB24, rgb, 3 * width);
    SDL_RenderPresent(w->renderer);
    return good ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_IO, "cannot render in the window: %s", SDL_GetError());
}

const adcgs_sdl adcgs_play_table = {
    .version = PACKAGE_VERSION,
    .open = window_open,
    .close = window_close,
    .size = window_size,
    .resize = window_resize,
    .event = window_event,
    .push = window_push,
    .wake = window_wake,
    .fullscreen = window_fullscreen,
    .capture = window_capture,
    .picture = window_picture,
    .type = window_type,
    .plain = window_plain,
    .show = window_show,
};
