"""Files for other programs: VTKHDF for ParaView and pyvista, CSV tables, and GeoJSON."""

from udec_ia.export.export_files import export

__all__ = ["export"]
