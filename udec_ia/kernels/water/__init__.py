"""Water: volumes and pressures of domains, flow through contacts (report 2.6, 2.8)."""
