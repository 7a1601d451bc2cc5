/* SPDX-License-Identifier: MIT */
#include "experiment_classic.h"
void classic_page(const struct classic_report *report, struct page *page, const char *folder)
{
    (void)report;
    (void)page;
    (void)folder;
}
