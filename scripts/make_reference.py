#!/usr/bin/python3
"""Makes the reference equilibria that the statics tests compare with.

make_reference.py [OUT_DIR]     (default tests/statics/reference)

Solves the continuum equations of the paper's finger (continuum_finger.py) for
point contacts and circles. Loads grow from zero in small steps, so that the
equilibrium found is the one connected to the unloaded finger; a case whose path
reaches a singular point before the full load is left out and listed. Every case
is solved with more and more points a bay until two resolutions agree.
"""

import multiprocessing
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[0] / "common"))
import guard  # noqa: E402

guard.protect("make_reference.py", __name__)

import numpy as np
import yaml

from continuum_finger import Contact, Geometry, REAL, System, evaluate

ROOT = pathlib.Path(__file__).resolve().parent.parent
FINGER = ROOT / 'configs/fingers/paper_140mm.yaml'
EI = 12500
AGREEMENT = 1e-13
STEP_POINTS, FIRST_POINTS, MORE_POINTS, MOST_POINTS = 20, 24, 12, 84


def point_cases():
    """(group, EI front, EI back, [(arc, force, friction), ...])."""
    cases = []

    def add(group, stiffness, *contacts):
        contacts = [tuple(c) + (0,) * (3 - len(c)) for c in contacts]
        cases.append((group, *stiffness, contacts))

    for arc in (5, 10, 17, 20, 30, 45, 60, 72.4, 83, 95, 105, 110, 120, 130, 135):
        add('nominal', (EI, EI), (arc, 5))
    for force, arcs in ((0.05, (5, 20, 60, 95, 135)), (1, (17, 72.4, 110, 130)),
                        (20, (10, 30, 45, 60, 72.4, 83, 105, 120, 130))):
        for arc in arcs:
            add('nominal', (EI, EI), (arc, force))
    for contact in ((20, 5, -0.3), (72.4, 10, -0.3), (120, 5, -0.3), (45, 20, 0.2),
                    (105, 5, 0.2), (30, 5, 0.5), (60, 20, 0.5), (83, 10, 0.5)):
        add('friction', (EI, EI), contact)
    for pair in (((30, 5), (100, 3)), ((45, 2, 0.2), (95, 4, -0.3)),
                 ((20, 10), (72.4, 5)), ((17, 3), (105, 6, 0.2)),
                 ((50, 8), (70, 8)), ((10, 5, -0.3), (130, 2, 0.5)),
                 ((83, 10), (120, 5)), ((72.4, 4), (72.9, 4, 0.3))):
        add('two_contacts', (EI, EI), *pair)
    for stiffness in ((12500, 4000), (4000, 12500), (30000, 3000)):
        for contact in ((30, 5), (72.4, 10), (120, 5)):
            add('unequal', stiffness, contact)
    for stiffness, contacts in (
            (1250, ((45, 0.5), (72.4, 1.5), (110, 3), (20, 3))),
            (250, ((60, 0.5), (95, 1), (30, 2), (72.4, 3)))):
        for contact in contacts:
            add('soft', (stiffness, stiffness), contact)
    for stiffness, contacts in ((125000, ((45, 20), (72.4, 50), (110, 200))),
                                (12500000, ((20, 20), (60, 100), (120, 200)))):
        for contact in contacts:
            add('stiff', (stiffness, stiffness), contact)
    for force, arcs in ((50, (20, 60, 95, 130)), (100, (20, 30, 72.4, 110, 130)),
                        (125, (40, 70, 120)), (150, (70,)),
                        (200, (20, 25, 45, 60, 100, 105, 130))):
        for arc in arcs:
            add('heavy', (EI, EI), (arc, force))
    return cases


def circle_cases():
    """(group, EI front, EI back, height, radius, depth, friction)."""
    cases = [('circle', EI, EI, *c) for c in (
        (15, 10, 1, 0), (20, 5, 1.5, 0), (25, 30, 2, 0.3), (30, 15, 3, 0),
        (36, 8, 4, 0), (40, 20, 5, 0), (45, 40, 4, 0.2), (50, 10, 8, 0),
        (55, 25, 6, -0.3), (60, 5, 10, 0), (61, 15, 12, 0), (66, 40, 8, 0),
        (70, 12, 15, 0), (75, 30, 10, 0.3), (80, 20, 1, 0), (84, 8, 13, 0),
        (90, 15, 7, -0.3), (95, 35, 5, 0), (100, 10, 10, 0), (104, 20, 15, 0),
        (110, 5, 3, 0.2), (115, 15, 5, 0), (125, 5, 12, 0), (125, 5, 14, 0))]
    return cases + [('circle', 4000, 12500, 72, 15, 10, 0),
                    ('circle', 12500, 4000, 90, 25, 12, 0)]


class Singular(Exception):
    """The load path cannot be followed: the share of the load reached and why."""


def follow(geometry, contacts, circle):
    """Grows the load from nothing to all: system, state and steps taken."""
    system = System(geometry, contacts, STEP_POINTS, circle)
    state, sign = system.solve(system.zero(), REAL(0))
    largest = 0.1 if circle else 0.25
    step = min(largest, 0.5 / max(float(c.force) for c in contacts)) \
        if not circle else 0.02
    share, before, steps = REAL(0), None, 0
    while share < 1:
        step = min(step, largest, float(1 - share))
        guess = state
        if before is not None:
            guess = state + (state - before[0]) * REAL(step / before[1])
        to = REAL(1) if step >= float(1 - share) else share + REAL(step)
        found = system.solve(guess, to)
        change = system.turns(found[0] - guess) if found else 1
        if not found or change > 0.03 or found[1] != sign:
            step /= 2
            if step < 1e-7:
                # At a limit point the finger moves infinitely fast with the load.
                slope = system.turns(state - before[0]) / before[1] if before else 0
                raise Singular(float(share),
                               'limit point' if slope > 100 else 'path lost')
            continue
        before, state, share = (state, float(to - share)), found[0], to
        steps += 1
        step *= 1.6 if change < 0.01 else 1
        if circle and np.any(np.diff(system.ends(state, 0)) <= 0):
            system, state, sign = renewed(system, state, share, STEP_POINTS)
            before = None
            step /= 4
    return system, state, steps


def renewed(system, state, share, points):
    """The same with other points, the circle's bays around where it now is."""
    contacts = system.contacts
    if system.circle:
        contacts = [Contact(state[-2], 0, contacts[0].friction)]
    new = System(system.geometry, contacts, points, system.circle)
    found = new.solve(system.moved_to(new, state), share, final=True, limit=20)
    if not found:
        raise Singular(float(share), 'no solution with other points')
    return new, *found


def outputs(system, state):
    """Named results in mm, N, rad."""
    g = system.geometry
    out, n = {}, system.n
    ends = system.ends(state, 0)
    for c, contact in enumerate(system.contacts):
        k = system.contact_station[c]
        phi, _, u, v = (f[n] for f in system.fields(state, 0, k)[0])
        name = f'contact_{c + 1}_'
        out[name + 'mm'] = ends[k + 1] * g.unit_mm
        out[f'normal_{c + 1}_N'] = system.load(state, c, REAL(1)) * g.force_N
        out[name + 'x_mm'] = u * g.unit_mm
        out[name + 'y_mm'] = (ends[k + 1] + v) * g.unit_mm
        out[name + 'angle_rad'] = g.angle[0] + phi
    phi, _, u, v = (f[n] for f in system.fields(state, 0, system.bays[0] - 1)[0])
    out.update(tip_x_mm=u * g.unit_mm, tip_y_mm=(1 + v) * g.unit_mm,
               tip_angle_rad=g.angle[0] + phi)
    for rib in range(len(g.ribs)):
        out[f'rib_{rib + 1}_N'] = state[system.rib_row + rib] * g.force_N
    for j, (side, start, end) in enumerate(g.gauges):
        out[f'gauge_{j + 1}_rad'] = system.angle_at(state, side, end) - \
            system.angle_at(state, side, start)
    return out


def difference(geometry, a, b):
    """Largest relative difference: lengths over l_0, angles in rad, ribs and
    gauges and forces over the largest of their kind."""
    worst = 0
    for kind in ('rib', 'gauge', 'normal', ''):
        keys = [k for k in a if k.startswith(kind)] if kind else \
            [k for k in a if k.startswith(('tip', 'contact'))]
        unit = max(abs(b[k]) for k in keys)
        for k in keys:
            scale = unit if kind else REAL(1) if 'angle' in k else geometry.unit_mm
            worst = max(worst, abs(a[k] - b[k]) / scale)
    return float(worst)


def checks(system, state):
    """Balance of the whole finger, energy invariant of the bays, clearance."""
    g, n = system.geometry, system.n
    force, moment, size = np.zeros(2, dtype=REAL), REAL(0), REAL(0)
    energy = clearance = REAL(0)
    for side in range(2):
        (_, m, _, _), pull = system.fields(state, side, 0)
        force -= pull
        moment -= m[0] + g.base_x[side] * pull[1]
        size = max(size, abs(m[0]), np.max(np.abs(pull)))
        for bay in range(system.bays[side]):
            (phi, m, _, _), pull = system.fields(state, side, bay)
            theta = g.angle[side] + phi
            pulled = np.cos(theta) * pull[0] + np.sin(theta) * pull[1]
            total = m**2 * g.compliance[side] / 2 + pulled
            unit = np.max(m**2 * g.compliance[side] / 2) + np.hypot(*pull)
            energy = max(energy, np.ptp(total) / unit)
    for c in range(len(system.contacts)):
        k = system.contact_station[c]
        _, _, u, v = (f[n] for f in system.fields(state, 0, k)[0])
        push = system.push(state, c, REAL(1))[0]
        force += push
        moment += u * push[1] - (system.ends(state, 0)[k + 1] + v) * push[0]
    if system.circle:
        radius, _, centre = system.circle
        ends = system.ends(state, 0)
        distances = []
        for bay in range(system.bays[0]):
            at = np.linspace(0, 1, 401)
            u, v = (evaluate(system.coefficients, f, at)
                    for f in system.fields(state, 0, bay)[0][2:])
            y = ends[bay] + (ends[bay + 1] - ends[bay]) * at + v
            distances.append(np.min(np.hypot(u - centre[0], y - centre[1])))
        clearance = (min(distances) - radius) * g.unit_mm
    return (float(np.max(np.abs(force)) / size), float(abs(moment) / size),
            float(energy), float(clearance))


def run(case):
    finger = yaml.safe_load(FINGER.read_text())
    geometry = Geometry(finger, *case[1:3])
    mm, row = geometry.unit_mm, {}
    if case[0] == 'circle':
        _, _, _, height, radius, depth, friction = case
        contacts = [Contact(REAL(height) / mm, 0, REAL(str(friction)))]
        circle = (radius / mm, (-radius / mm, REAL(height) / mm),
                  (REAL(depth - radius) / mm, REAL(height) / mm))
        name = f'y{height}_R{radius}_depth{depth}_mu{friction}'
        row = {'object_x_mm': depth - radius, 'object_y_mm': height,
               'radius_mm': radius, 'friction_1': friction}
    else:
        circle = None
        contacts = [Contact(REAL(str(a)) / mm, REAL(str(f)) / geometry.force_N,
                            REAL(str(mu))) for a, f, mu in case[3]]
        name = '_and_'.join(f'{a}mm_{f}N' + (f'_mu{mu}' if mu else '')
                            for a, f, mu in case[3])
        for c, contact in enumerate(case[3]):
            keys = (f'contact_{c + 1}_mm', f'normal_{c + 1}_N', f'friction_{c + 1}')
            row.update(zip(keys, contact))
    if case[1:3] != (EI, EI):
        name = f'EI{case[1]}_{case[2]}_' + name
    row = {'case': f'{case[0]}_{name}', 'group': case[0],
           'front_stiffness_N_mm2': case[1], 'back_stiffness_N_mm2': case[2], **row}
    try:
        system, state, steps = follow(geometry, contacts, circle)
    except Singular as stop:
        return {'row': row, 'stop': stop.args}
    last = None
    for points in range(FIRST_POINTS, MOST_POINTS + 1, MORE_POINTS):
        system, state, _ = renewed(system, state, REAL(1), points)
        out = outputs(system, state)
        agreement = difference(geometry, last, out) if last else 1
        if agreement < AGREEMENT:
            break
        last = out
    return {'row': {**out, **row}, 'points': points, 'agreement': agreement,
            'checks': checks(system, state), 'steps': steps}


def columns(circle, contacts):
    first = ['case', 'group', 'front_stiffness_N_mm2', 'back_stiffness_N_mm2']
    if circle:
        first += ['object_x_mm', 'object_y_mm', 'radius_mm']
    for c in range(1, contacts + 1):
        first += [f'contact_{c}_mm', f'normal_{c}_N', f'friction_{c}']
    for c in range(1, contacts + 1):
        first += [f'contact_{c}_{k}' for k in ('x_mm', 'y_mm', 'angle_rad')]
    first += ['tip_x_mm', 'tip_y_mm', 'tip_angle_rad']
    return first + [f'rib_{i}_N' for i in range(1, 6)] + \
        [f'gauge_{j}_rad' for j in range(1, 5)]


def cell(value):
    if isinstance(value, (str, int)):
        return str(value)
    return '' if value is None else f'{float(value):.17g}'


def write(path, results, names):
    good = [r for r in results if 'stop' not in r]
    worst = [max(r['checks'][k] for r in good) for k in range(3)]
    lines = ['Equilibria of the finger of configs/fingers/paper_140mm.yaml, made by',
             'scripts/make_reference.py: global Chebyshev collocation of the continuum',
             'equations, every load followed from zero in small steps.',
             f'{len(good)} cases, up to {max(r["points"] for r in good)} points a bay. '
             'Worst relative figures:',
             f'two resolutions differ by {max(r["agreement"] for r in good):.1e}; '
             'balance of the whole finger:',
             f'force {worst[0]:.1e}, moment {worst[1]:.1e}; M^2 / 2 EI + t . N along a '
             f'bay {worst[2]:.1e}.']
    for r in results:
        if 'stop' in r:
            lines.append(f'Left out: {r["row"]["case"]}, {r["stop"][1]} at '
                         f'{r["stop"][0]:.6f} of the load.')
    text = ''.join(f'# {line}\n' for line in lines) + ','.join(names) + '\n'
    for r in good:
        text += ','.join(cell(r['row'].get(k)) for k in names) + '\n'
    path.write_text(text)
    print('\n'.join(lines))


def main():
    folder = pathlib.Path(*guard.words(__doc__, 0, 1) or [ROOT / 'tests/statics/reference'])
    folder.mkdir(parents=True, exist_ok=True)
    with multiprocessing.Pool(2) as pool:
        for file, cases, contacts in (('point_contacts.csv', point_cases(), 2),
                                      ('circle_contacts.csv', circle_cases(), 1)):
            results = []
            for r in pool.imap(run, cases):
                results.append(r)
                if 'stop' in r:
                    print(r['row']['case'], 'left out', *r['stop'], flush=True)
                    continue
                print(r['row']['case'], 'steps', r['steps'], 'points', r['points'],
                      'agree %.1e force %.1e moment %.1e energy %.1e clearance %.1e' %
                      (r['agreement'], *r['checks']), flush=True)
            write(folder / file, results, columns(file[0] == 'c', contacts))


if __name__ == '__main__':
    main()
