"""Operating beambench: nights and their history, the site, campaigns, and publishing.

Each part is a package: history, site, nightly, campaign, publish, in this order.
"""
