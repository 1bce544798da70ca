# SPDX-License-Identifier: BSD-2-Clause
"""Tables of annex "Worked examples" on splats: a splat, an anchor that moves, a pixel."""
from watching import F64, camera_of  # first: it makes the modules of the executor importable
from binary import Literal, binary32
from example_format import number, patterned, table


def splat_table(machine, splat, time):
    rows = [(name, ", ".join("`%s`" % patterned(machine, x) for x in getattr(splat, name))) for name in
            ("mean", "scale", "rotation", "colour")]
    rows.insert(3, ("opacity", "`%s`" % patterned(machine, splat.opacity)))
    return [".Splat in slot %d at %s seconds" % (splat.slot, time)] + table("1,8", ("Element", "Values (patterns)"), rows)


def field_rows(machine, record):
    """Numbers of a record, with arrays in one row."""
    rows = []
    for name, value in record.__dict__.items():
        values = value if isinstance(value, list) else [value]
        if values and all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in values):
            shown = ", ".join("`%s`" % (patterned(machine, v) if isinstance(v, float) else v) for v in values)
            rows.append((name, shown))
    return rows


def pixel_tables(watch, stream, splats, entry):
    """The pixel nearest to the middle that shows a splat: the first projection, then the effect of each splat on the pixel."""
    machine, camera = watch.machine, camera_of(entry)
    watch.keep("project", "ordered", "make_view")
    frame = machine.render(stream.head, splats, camera)
    view, drawn = watch.calls["make_view"][-1][1], watch.calls["ordered"][-1][1]
    lines = camera_table(entry)
    lines += [".The view of camera \"%s\"" % entry["name"]] + table("1,8", ("Element", "Values (patterns)"), field_rows(machine, view))
    for _, projected in [call for call in watch.calls["project"] if call[1] is not None][:1]:
        lines += [".Projection of the splat in slot %d" % projected.slot]
        lines += table("1,8", ("Element", "Values (patterns)"), field_rows(machine, projected))
    j, i = nearest_drawn(frame, stream.head.background)
    steps = watch.locals_of("blend_pixel", lambda: machine.blend_block(view, drawn, i - i % 4, j - j % 4))
    names = ("dx", "dy", "power", "alpha", "weight")
    rows, here = [], (number(i + 0.5), number(j + 0.5))
    for step in [step for step in steps if (number(step["pixel"].x), number(step["pixel"].y)) == here][:8]:
        rows.append([step["s"].slot] + ["`%s`" % patterned(machine, step[n]) if n in step else "" for n in names])
    lines += [".Effect of the first splats on the pixel in column %d, row %d" % (i, j)]
    lines += table("1,3,3,3,3,3", ("Slot",) + names, rows)
    lines += ["The pixel's values are %s." % ", ".join("`%s`" % patterned(machine, x) for x in frame[j][i]), ""]
    lines += ["The digest of the frame, %d × %d pixels, is `%s`." % (view.width, view.height, bytes(machine.frame_digest(frame)).hex()), ""]
    return lines


def camera_table(entry):
    """A camera in the form of a request or of the manifest."""
    pose = entry["cam_to_world"]
    rows = [("width, height", "%d, %d" % (entry["width"], entry["height"]))]
    rows += [(names, ", ".join("%.17g" % entry[name] for name in names.split(", "))) for names in ("fx, fy", "cx, cy")]
    rows += [("near_plane", "%.17g" % entry["near"])]
    rows += [("row %d of cam_to_world" % i, ", ".join("%.17g" % x for x in pose[4 * i:4 * i + 4])) for i in range(3)]
    return [".The camera \"%s\"" % entry["name"]] + table("2,7", ("Element", "Values"), [(a, "`%s`" % b) for a, b in rows])


# ---- An anchor that moves ----

def first_moving(model):
    """The first anchor that is not static and its first primitive, if possible of a body; None if no anchor moves."""
    if model.network[9] is None and model.network[10] is None and model.head.bodies == 0:
        return None
    found = [(i, k) for i in range(model.anchors) for k in range(model.head.k) if not model.is_static[i] and model.mask[i] >> k & 1]
    return min(found, key=lambda place: model.body[place[0]] == 0) if found else None


def patterns(machine, values):
    shown = ["`%s`" % patterned(machine, x) for x in values[:16]]
    return (", ".join(shown) if shown else "none") + (", … (%d in all)" % len(values) if len(values) > 16 else "")


def network_rows(watch, name, layers, inputs, f_t):
    """A deformation network on its inputs: both sums of its first layer and their total, sums of the later layers, outputs."""
    machine, calls = watch.machine, watch.calls["accumulate"]
    before = len(calls)
    y = machine.deform_outputs(layers, inputs, f_t)
    of_anchor, of_time, *later = [result for _, result in calls[before:]]
    rows = [("%s: inputs of the anchor" % name, inputs), ("%s: of_anchor" % name, of_anchor), ("%s: of_time" % name, of_time),
            ("%s: sums of the first layer" % name, [a + b for a, b in zip(of_anchor, of_time)])]
    return rows + [("%s: sums of layer %d" % (name, l), sums) for l, sums in enumerate(later, 1)], y


def state_rows(when, position, primitive):
    fields = [(name, value if isinstance(value, list) else [value]) for name, value in primitive.__dict__.items()]
    return [("%s: position" % when, list(position))] + [("%s: %s" % (when, name), list(value)) for name, value in fields]


def moving_table(watch, model, time, splats):
    """The computation of the first primitive of the first moving anchor, from its features to its splat."""
    machine, place = watch.machine, first_moving(model)
    if place is None:
        return []
    watch.keep("accumulate")
    i, k = place
    networks = [machine.float_network(model.network[role]) for role in (8, 9, 10)]
    t = machine.time_in_segment(model, F64(float(time)))
    code = machine.time_code(model, t)
    f_t = code[:model.head.time_width]
    f_v = machine.features(model.fv[i], model.d_fv, Literal(1.0))
    rows = [("t", [t]), ("f~t~", f_t), ("f~v~", f_v)]
    primitive, position = machine.predict(model, networks[0], i, k), machine.anchor_position(model, i)
    rows += state_rows("at rest", position, primitive)
    if networks[1] is not None:
        more, y = network_rows(watch, "F~ω~", networks[1], f_v, f_t)
        rows += more
        position = machine.move_anchor(model, i, y, position, primitive)
    presence = binary32(1)
    if model.head.spans == 1:
        life = machine.live(model, i, t, position)
        position, presence = life.position, life.presence
        rows += [("presence", [presence])]
    body = model.body[i]
    if body > 0:
        pose, centre = machine.body_pose(model, code, body), machine.body_centre(model, body)
        position = machine.carry(pose, centre, position, primitive)
        rows += [("turn of the body", pose.q), ("its centre", centre), ("its way", pose.way)]
    if networks[2] is not None:
        inputs = machine.position_code(model, i) + (f_v if model.head.fine_uses_fv == 1 else [])
        more, z = network_rows(watch, "F~ϖ~", networks[2], inputs, f_t)
        rows += more
        machine.change_primitive(k, z, primitive)
    rows += state_rows("moved", position, primitive)
    splat = machine.splat(model, i, k, position, presence, primitive)
    assert any(splat.__dict__ == other.__dict__ for other in splats)
    title = ".Anchor %d and its primitive %d at %s seconds, splat in slot %d" % (i, k, time, splat.slot)
    return [title] + table("3,8", ("Quantity", "Values (patterns)"), [(name, patterns(machine, values)) for name, values in rows])


def nearest_drawn(frame, background):
    """Row and column of the pixel nearest to the middle whose colour is not the background's."""
    height, width = len(frame), len(frame[0])
    drawn = [((2 * j + 1 - height) ** 2 + (2 * i + 1 - width) ** 2, j, i) for j in range(height) for i in range(width)
             if any(frame[j][i][c] != background[c] for c in range(3))]
    return min(drawn)[1:] if drawn else (0, 0)
