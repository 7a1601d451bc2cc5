// SPDX-License-Identifier: MIT
package rhotrack.spy;

import rhotrack.spy.scene.Bounds;

/**
 * Transforms between the local frame (metres, y up) and the screen (pixels, y down), with one scale
 * for both axes.
 */
final class ViewTransform {
    private static final double MIN_METRES_PER_PIXEL = 0.01;
    private static final double MAX_METRES_PER_PIXEL = 2e4;

    private double centreX;
    private double centreY;
    private double metresPerPixel = 100;
    private int width = 1;
    private int height = 1;

    void resize(int newWidth, int newHeight) {
        width = Math.max(1, newWidth);
        height = Math.max(1, newHeight);
    }

    double metresPerPixel() {
        return metresPerPixel;
    }

    double screenX(double x) {
        return width / 2.0 + (x - centreX) / metresPerPixel;
    }

    double screenY(double y) {
        return height / 2.0 - (y - centreY) / metresPerPixel;
    }

    double worldX(double screenX) {
        return centreX + (screenX - width / 2.0) * metresPerPixel;
    }

    double worldY(double screenY) {
        return centreY - (screenY - height / 2.0) * metresPerPixel;
    }

    /** The area of the local frame that is on the screen. */
    Bounds visibleBounds() {
        return new Bounds(worldX(0), worldY(height), worldX(width), worldY(0));
    }

    /**
     * Zooms in by a factor above 1, out by one below; the place at the given pixel stays there.
     */
    void zoomAbout(double screenX, double screenY, double factor) {
        double x = worldX(screenX);
        double y = worldY(screenY);
        metresPerPixel = limitedScale(metresPerPixel / factor);
        centreX += x - worldX(screenX);
        centreY += y - worldY(screenY);
    }

    /** Moves the picture by a number of pixels. */
    void pan(double right, double down) {
        centreX -= right * metresPerPixel;
        centreY += down * metresPerPixel;
    }

    /** Shows all of the bounds in the middle, with a margin in pixels for symbols and labels. */
    void fit(Bounds bounds, int margin) {
        double across = bounds.width() / Math.max(1, width - 2 * margin);
        double up = bounds.height() / Math.max(1, height - 2 * margin);
        double scale = Math.max(across, up);
        // a single place is shown with a few kilometres about it
        metresPerPixel = limitedScale(scale > 0 ? scale : 10);
        centreX = (bounds.west() + bounds.east()) / 2;
        centreY = (bounds.south() + bounds.north()) / 2;
    }

    private static double limitedScale(double scale) {
        return Math.max(MIN_METRES_PER_PIXEL, Math.min(MAX_METRES_PER_PIXEL, scale));
    }
}
