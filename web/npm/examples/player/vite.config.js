// SPDX-License-Identifier: BSD-2-Clause
// The development server must not bundle adcgs: its scripts find the module next to themselves.
export default { base: './', optimizeDeps: { exclude: ['adcgs'] } };
