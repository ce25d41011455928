"""Finite elements on the solid itself: stiffness, first torsional frequency and stress of a shaft.

For designs and for the REST interface, by `cad.analysis.analyse`. The mesh is made from the bytes of the STEP
file that is served; linear elasticity, small displacements, one isotropic material. Valid for one solid that
is held by the face at one of its ends and loaded at the other.

References
----------
Schöberl 1997: NETGEN, an advancing front 2D/3D-mesh generator (Computing and Visualization in Science 1).
Schöberl 2014: C++11 implementation of finite elements in NGSolve (TU Wien).
"""
