"""Slopes of a solid over the parameters of its model, without another Boolean operation.

Call `cad.slopes.solid_slopes`. The other modules, in the order in which it uses them:

- `face_integrals` integrates over the faces of the built solid.
- `operands` runs `build()` with all Boolean operations replaced by compounds of their arguments. This takes
  about a thirtieth of the time.
- `carriers` reads the plane, cylinder, cone, sphere or torus of each face of an operand, and its velocity.
- `variations` draws the operands at values of a parameter beside its own. Other faces there mean that a
  feature appears: no slope. A rule that closes one side leaves the slope of the other. At a kink the ratio of
  the second differences of two steps is 2 instead of 4.

The numbers of a carrier are nearly linear in a parameter, so their difference quotients are accurate to about
1e-8; differences of volumes lose that in the kernel's tolerances. Closed forms of volumes are the second
method in the tests; they give neither centre nor inertia.
"""
