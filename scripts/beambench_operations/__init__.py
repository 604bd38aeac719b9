"""Operating beambench: nights and their history, the site, campaigns, and what is published.

Each is a package of its own: history, site, nightly, campaign, publish, in this order.
"""
