"""The simulation codes that a card is made for: each is one module with a CODE, and its line here."""

from . import (
    adams,
    chrono,
    damping_family,
    drake,
    exudyn,
    exudyn_damped,
    lammps,
    liggghts,
    mujoco,
    recurdyn,
    simbody,
    yade,
)

CODES = {
    code.name: code
    for code in (
        adams.CODE,
        chrono.CODE,
        damping_family.CODE,
        drake.CODE,
        exudyn.CODE,
        exudyn_damped.CODE,
        lammps.CODE,
        liggghts.CODE,
        mujoco.CODE,
        recurdyn.CODE,
        simbody.CODE,
        yade.CODE,
    )
}
