"""The numerics of studies: which rows to calculate, and what follows from their results.

Pure functions over a callable: no database, no clock. Equal seeds give equal rows. So an interrupted study
repeats its calls, and the callable answers the earlier ones from storage.

space           the box of the varied values, as a unit cube and in SI
points          rows of grids, Sobol' sequences and Latin hypercubes, any chunk without the others
sensitivity     slopes at a point; Morris' screening and Sobol' indices by SALib
answers         objectives and criteria of rows, and what to optimise
corrected       a coarse level times the ratios that a fine level showed
polish          from a place to the nearest optimum, by SLSQP
search          the optimum at one level: scan, then polish
confirming      a promise of the coarse level beside what the fine level has
optimise        explore at the coarse level, confirm at the fine one, correct, repeat
front           the same for several objectives, by NSGA-II of pymoo
trade           which optimum each level finds alone, its promise and what is confirmed
"""
