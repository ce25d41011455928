"""Reference values from a second program, openTorsion 0.3.2, order by order, on our own trains.

Writes forced_torsion.json beside this file: the inputs as `forced_torsion` takes them, and the amplitude of
each shaft's torque at each speed and order from openTorsion's angles. It is not needed by the tests:

    pip install opentorsion==0.3.2; python tests/references/forced_torsion.py
"""

import json
from pathlib import Path

import numpy as np
import opentorsion as ot

STEP = 15.0  # deg
LINES, STROKES = 16, 4


def curves():
    """Gas torque, and inertia torque at 1500 rpm, of one cylinder over 720 deg."""
    theta = np.radians(np.arange(0, 720, STEP))
    gas = 2500 * np.exp(-(((theta - 0.5) / 0.4) ** 2)) - 500 * np.exp(
        -(((theta - 4 * np.pi + 0.5) / 0.5) ** 2)
    )
    inertia = -180 * np.sin(2 * theta) + 45 * np.sin(theta) - 50 * np.sin(3 * theta)
    return np.round(gas, 1), np.round(inertia, 1)


def diesel():
    """Six cylinders with a viscous damper, a flywheel, and a load on a rubber coupling."""
    return {
        "inertias": [0.08, 0.02, *[0.045] * 6, 2.1, 0.6],
        "shaft_from": list(range(1, 10)),
        "shaft_to": list(range(2, 11)),
        "shaft_stiffness": [0, 1.6e6, *[1.25e6] * 5, 1.9e6, 2e4],
        "shaft_damping": [12, 0, *[2] * 5, 3, 5],
        "loss_factors": [0, 0, *[0.004] * 5, 0, 0.15],
        "absolute_damping": [0, 0, *[2] * 6, 0, 6],
        "excited_inertias": [3, 4, 5, 6, 7, 8],
        "firing_angles": [0, 480, 240, 600, 120, 360],  # 1-5-3-6-2-4
        "speeds": [700, 1150, 1600, 2050],
    }


def geared():
    """Two cylinders that drive a propeller by a reduction, with a branch on the first inertia."""
    return {
        "inertias": [0.05, 0.06, 0.9, 0.04, 0.7, 4.0, 0.03],
        "shaft_from": [1, 2, 3, 5, 1],
        "shaft_to": [2, 3, 4, 6, 7],
        "shaft_stiffness": [9e5, 7e5, 6e4, 2e5, 3e4],
        "shaft_damping": [4, 3, 20, 10, 2],
        "loss_factors": [0, 0, 0, 0, 0],
        "absolute_damping": [1, 1, 0, 0, 0, 9, 0],
        "gear_from": [4],
        "gear_to": [5],
        "gear_ratios": [-0.5],
        "excited_inertias": [1, 2],
        "firing_angles": [0, 360],
        "speeds": [600, 1200, 1900],
    }


def solved(train, gas, inertia):
    """Amplitudes of the shafts' torques [speed][order][shaft], from openTorsion's angles."""
    ends = [(i - 1, j - 1) for i, j in zip(train["shaft_from"], train["shaft_to"], strict=True)]
    values = list(
        zip(ends, train["shaft_stiffness"], train["shaft_damping"], train["loss_factors"], strict=True)
    )
    gears = list(zip(train.get("gear_from", []), train.get("gear_to", []), train.get("gear_ratios", []),
                     strict=True))  # fmt: skip
    toothed = {n for i, j, _ in gears for n in (i, j)}
    disks = [
        ot.Disk(n - 1, inertia_, c=train["absolute_damping"][n - 1])
        for n, inertia_ in enumerate(train["inertias"], 1) if n not in toothed
    ]  # fmt: skip

    def assembly(shafts):
        wheels = []
        for i, j, ratio in gears:
            parent = ot.Gear(i - 1, I=train["inertias"][i - 1], R=abs(ratio))
            wheels += [parent, ot.Gear(j - 1, I=train["inertias"][j - 1], R=1.0, parent=parent)]
        return ot.Assembly(shafts, disk_elements=disks, gear_elements=wheels or None)

    plain = assembly([ot.Shaft(*e, k=k, c=c) for e, k, c, _ in values])
    inner = assembly([ot.Shaft(*e, k=k * eta, c=0.0) for e, k, _, eta in values]).K
    turn = plain.T(plain.E()) if gears else np.eye(len(train["inertias"]))
    lines = [2 * np.fft.rfft(curve)[1 : LINES + 1] / curve.size for curve in (gas, inertia)]
    orders = np.arange(1, LINES + 1) * 2 / STROKES
    firing = np.radians(train["firing_angles"])
    amplitudes = []
    for speed in np.asarray(train["speeds"]) * np.pi / 30:
        w = orders * speed
        excitation = ot.PeriodicExcitation(len(train["inertias"]), w)
        for place, phi in zip(train["excited_inertias"], firing, strict=True):
            torque = (lines[0] + lines[1] * (speed / (1500 * np.pi / 30)) ** 2) * np.exp(-1j * orders * phi)
            excitation.add_sines(place - 1, w, np.abs(torque), np.angle(torque))
        angles = turn @ plain.ss_response(turn.T @ excitation.U, w, C_func=lambda at: plain.C + inner / at)[0]
        torques = [
            (k * (1 + 1j * eta) + 1j * w * c) * (angles[i] - angles[j]) for (i, j), k, c, eta in values
        ]
        amplitudes.append(np.abs(torques).T.tolist())
    return amplitudes


def main():
    """Both trains."""
    gas, inertia = curves()
    cases = {}
    for name, train in (("diesel", diesel()), ("geared", geared())):
        amplitudes = solved(train, gas, inertia)
        rounded = [[[float(f"{one:.10g}") for one in row] for row in rows] for rows in amplitudes]
        cases[name] = {"train": train, "amplitudes": rounded}
    record = {
        "source": "openTorsion 0.3.2", "crank_angle_step": STEP, "gas_torque": gas.tolist(),
        "inertia_torque": inertia.tolist(), "inertia_speed": 1500, "highest_order": LINES * 2 / STROKES,
        "cases": cases,
    }  # fmt: skip
    Path(__file__).with_suffix(".json").write_text(json.dumps(record) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
