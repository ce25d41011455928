"""Finite-element analysis of a solid: stiffness, first torsional frequency and stress of a shaft.

Designs and the REST interface call `cad.analysis.analyse`. The mesh is generated from the bytes of the served
STEP file. The analyses assume linear elasticity, small displacements and one isotropic material. They are
valid for one solid that is held at the face of one end and loaded at the other end.

References
----------
Schöberl 1997: NETGEN, an advancing front 2D/3D-mesh generator (Computing and Visualization in Science 1).
Schöberl 2014: C++11 implementation of finite elements in NGSolve (TU Wien).
"""
