"""Double cantilever beam under uneven bending moments: a cohesive zone opens and slides, in four mixtures of modes."""
from lib.uneven_moments import case

CASE = case(
    "Mixed mode under uneven bending moments", "G = 12 M_s²/(E h³) + 9 M_a²/(E h³) (Sørensen et al. 2006), energy of fracture by Benzeggagh and Kenane (1996)",
    "G is exact. The arms are stretched by 7e-4 at the layer, whose tractions act on the area as it is. Within the zone of softening, half as long "
    "as an arm is high, the mixture varies: from 0.36 to 0.15 where G_II/G is 0.2. G rises and falls as the crack passes nodes (1 %).",
    (0.2, 0.4, 0.6, 0.8), 40,
    "The crack grows at shares G_II/G of 0.2, 0.4, 0.6 and 0.8 with energies of fracture of 0.3 and 0.8 in modes I and II. Moments stay as they are while it grows. The strengths are nearly "
    "in the ratio √(G_IIc K_s/(G_Ic K_n)), with which the mixture at the onset of damage matters little (Turon et al. 2010).")
