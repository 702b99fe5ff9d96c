"""Run a card in the code that it is for, and print what that returns at every measured speed.

    loopsheet card paper --for mujoco --format json | python benchmarks/card_in_code.py

for mujoco, exudyn and exudyn-damped, in an environment that has the code (mujoco 4.0.0 and exudyn 1.13.6 were
used). Each impact is run with two time steps: what is left of the difference to the card falls with them.
"""

import json
import sys
from collections.abc import Iterator
from typing import Any

STEPS = 1000, 4000
"""In a contact time."""
RADIUS = 6.35e-3


def in_mujoco(
    typed: dict[str, float], mass: float, speed: float, step: float, steps: int
) -> tuple[float, float]:
    """Restitution and greatest approach."""
    import mujoco

    contact = f'condim="1" solref="{typed["solref[0]"]!r} {typed["solref[1]"]!r}" solimp="0.999 0.999 0.001"'
    model = mujoco.MjModel.from_xml_string(f"""
        <mujoco>
          <option timestep="{step!r}" gravity="0 0 0" integrator="RK4"><flag refsafe="disable"/></option>
          <worldbody>
            <geom type="plane" size="1 1 1" {contact}/>
            <body pos="0 0 {RADIUS}">
              <joint type="slide" axis="0 0 1"/>
              <inertial mass="{mass!r}" pos="0 0 0" diaginertia="1 1 1"/>
              <geom type="sphere" size="{RADIUS}" {contact}/>
            </body>
          </worldbody>
        </mujoco>""")
    data = mujoco.MjData(model)
    data.qvel[0], deepest = -speed, 0.0
    for _ in range(5 * steps):
        mujoco.mj_step(model, data)
        deepest = max(deepest, -float(data.qpos[0]))
        if data.qpos[0] > 0:
            break
    return float(data.qvel[0]) / speed, deepest


def in_exudyn(
    typed: dict[str, float], mass: float, speed: float, step: float, steps: int
) -> tuple[float, float]:
    """Restitution, and the imprint where there is one."""
    import exudyn
    from exudyn import itemInterface as items

    damped = "restitutionCoefficient" in typed
    gap = 2e-6 if damped else 0.0  # the impact speed is taken at the first touch, not at the start
    system = exudyn.SystemContainer().AddSystem()
    fixed = system.AddMarker(items.MarkerBodyRigid(bodyNumber=system.AddObject(items.ObjectGround())))
    place, moving = [0, 0, 2 * RADIUS + gap, 1, 0, 0, 0], [0, 0, -speed, 0, 0, 0, 0]
    node = system.AddNode(items.NodeRigidBodyEP(referenceCoordinates=place, initialVelocities=moving))
    inertia = [1e-6, 1e-6, 1e-6, 0, 0, 0]
    ball = system.AddObject(items.ObjectRigidBody(mass=mass, inertia=inertia, nodeNumber=node))
    marker = system.AddMarker(items.MarkerBodyRigid(bodyNumber=ball))
    state = system.AddNode(items.NodeGenericData(initialCoordinates=[0, 0, 0, 0], numberOfDataCoordinates=4))
    model = {"impactModel": 2, "minimumImpactVelocity": 1e-3} if damped else {"impactModel": 0}
    contact = {"spheresRadii": [RADIUS, RADIUS], "contactDamping": 0, "dynamicFriction": 0, **model, **typed}
    system.AddObject(
        items.ObjectContactSphereSphere(markerNumbers=[fixed, marker], nodeNumber=state, **contact)
    )
    system.Assemble()
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = int(1.5 * steps)
    settings.timeIntegration.endTime = 1.5 * steps * step
    settings.solution.file.write = False
    settings.timeIntegration.generalizedAlpha.spectralRadius = 1
    system.SolveDynamic(settings)
    rebound = system.GetNodeOutput(node, exudyn.OutputVariableType.Velocity)[2]
    return rebound / speed, system.GetNodeOutput(state, exudyn.OutputVariableType.Coordinates)[3]


CODES = {"mujoco": in_mujoco, "exudyn": in_exudyn, "exudyn-damped": in_exudyn}


def returned(card: dict[str, Any]) -> Iterator[str]:
    typed = {one["word"]: one["value"] for one in card["typed"]}
    for row in card["rows"]:
        for steps in STEPS:
            try:
                e, depth = CODES[card["name"]](
                    typed, card["mass"], row["speed"], card["duration"] / steps, steps
                )
            except (RuntimeError, ValueError) as error:  # Exudyn gives up where a step just meets the surface
                yield f"{row['speed']:6.3f} m/s  {steps:5} steps  {error}"
            else:
                found = f"e {e:.7f}, card {row['by_card']:.7f}  {depth:.6g} m"
                yield f"{row['speed']:6.3f} m/s  {steps:5} steps  {found}"


if __name__ == "__main__":
    for line in returned(json.load(sys.stdin)):
        print(line)
