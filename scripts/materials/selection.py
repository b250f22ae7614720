"""Which materials, under which names, and from which pages of the database; the first source is the default."""


def main_shelf(book, *pages):
    """Sources by the names of their pages on the main shelf."""
    return [(page.replace(" ", "_"), "main", book, page) for page in pages]


def metal(symbol, name, *pages, also=()):
    return (symbol, [name, *also], main_shelf(symbol, *pages))


MATERIALS = [
    metal("Ag", "silver", "Johnson", "McPeak", "Babar", "Werner", "Rakic-BB", "Hagemann"),
    metal("Al", "aluminium", "Rakic", "McPeak", "Mathewson", "Ordal", "Hagemann", also=["aluminum"]),
    metal("Au", "gold", "Johnson", "McPeak", "Olmon-ev", "Babar", "Yakubovsky-117nm",
          "Werner", "Rakic-BB", "Ordal"),
    metal("Co", "cobalt", "Johnson", "Werner"),
    metal("Cr", "chromium", "Johnson", "Rakic-BB", also=["chrome"]),
    metal("Cu", "copper", "Johnson", "McPeak", "Babar", "Werner", "Rakic-BB", "Ordal", "Hagemann"),
    metal("Fe", "iron", "Johnson", "Werner", "Ordal"),
    metal("Ir", "iridium", "Roberts"),
    metal("Mo", "molybdenum", "Kirillova", "Werner", "Ordal"),
    metal("Ni", "nickel", "Johnson", "Werner", "Rakic-BB", "Ordal"),
    metal("Pd", "palladium", "Johnson", "Werner", "Rakic-BB"),
    metal("Pt", "platinum", "Rakic-BB", "Werner", "Windt"),
    metal("Rh", "rhodium", "Weaver"),
    metal("Ti", "titanium", "Johnson", "Werner", "Rakic-BB", "Mash", "Ordal"),
    metal("V", "vanadium", "Johnson", "Werner"),
    metal("W", "tungsten", "Weaver", "Werner", "Rakic-BB", "Ordal", also=["wolfram"]),
    metal("TiN", "titanium nitride", "Pfluger"),
    metal("Si", "silicon", "Green-2008", "Aspnes", "Schinke", "Salzberg", "Li-293K"),
    metal("Ge", "germanium", "Nunley", "Aspnes", "Jellison", "Icenogle", "Burnett", "Li-293K"),
    metal("GaAs", "gallium arsenide", "Aspnes", "Papatryfonos", "Jellison", "Skauli"),
    ("diamond", ["carbon"], [(page, "main", "C", page) for page in ("Phillip", "Peter")]),
    metal("ZnSe", "zinc selenide", "Connolly", "Marple", "Querry"),
    metal("ZnS", "zinc sulfide", "Debenham"),
    metal("MgO", "magnesium oxide", "Stephens", "Synowicki", also=["magnesia", "periclase"]),
    metal("TiO2", "titanium dioxide", "Devore-o", "Devore-e", "Bond-o", "Bond-e", "Jolivet-anatase",
          also=["titania", "rutile"]),
    metal("Al2O3", "aluminium oxide", "Malitson-o", "Malitson-e", "Malitson",
          also=["aluminum oxide", "alumina", "sapphire", "corundum"]),
    metal("SiO2", "fused silica", "Malitson", "Arosa", "Popova",
          also=["silica", "silicon dioxide", "quartz glass"]),
    ("quartz", ["crystal quartz", "alpha quartz"],
     [("Ghosh-o", "main", "SiO2", "Ghosh-o"), ("Ghosh-e", "main", "SiO2", "Ghosh-e")]),
    metal("CaF2", "calcium fluoride", "Malitson", "Daimon-20", also=["fluorite"]),
    metal("MgF2", "magnesium fluoride", "Dodge-o", "Dodge-e"),
    ("N-BK7", ["BK7", "borosilicate crown"], [("Schott", "specs", "SCHOTT-optical", "N-BK7")]),
    ("SF11", ["dense flint"], [("Schott", "specs", "SCHOTT-optical", "SF11")]),
    ("N-SF11", [], [("Schott", "specs", "SCHOTT-optical", "N-SF11")]),
    metal("H2O", "water", "Hale", "Daimon-20.0C", "Bashkatov"),
    ("PMMA", ["acrylic", "poly(methyl methacrylate)", "plexiglass"],
     [(page, "organic", "poly_methyl_methacrylate", page)
      for page in ("Sultanova", "Beadie", "Szczurowski", "Zhang-Mitsubishi")]),
    ("polycarbonate", ["PC"], [(page, "organic", "polycarbonate", page) for page in ("Sultanova",)]),
    ("polystyrene", ["PS"], [("Sultanova", "organic", "polystyrene", "Sultanova")]),
]
