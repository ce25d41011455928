"""Numerical methods of studies: they choose the rows to calculate, and evaluate the results.

The methods are pure functions over a callable; they use neither a database nor a clock. Equal seeds give
equal rows. So an interrupted study repeats its calls, and the callable returns the earlier results from
storage.

space           the box of the varied values, as a unit cube and in SI
points          rows of grids, Sobol' sequences and Latin hypercubes, in independent chunks
sensitivity     slopes at a point; Morris' screening and Sobol' indices by SALib
answers         objectives and criteria of rows, and what to optimise
correction      a coarse level multiplied by the ratios to a fine level
polish          local search for the nearest optimum, by SLSQP
search          the optimum at one level: scan, then polish
confirmation    the coarse level's prediction compared with the fine level's result
optimise        explore at the coarse level, confirm at the fine one, correct, repeat
front           the same steps for several objectives, by NSGA-II of pymoo
"""
